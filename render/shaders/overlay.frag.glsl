// Red of the atlas: how much of the texel the shape fills; green: the shape and the dark outline around it.
layout(binding = 2) uniform sampler2D atlas;
in vec2 uv;
in vec4 fill;
layout(location = 0) out vec4 colour;

void main() {
  vec2 cover = texture(atlas, uv).rg;
  colour = vec4(fill.rgb * (cover.r / max(cover.g, 0.001)), cover.g * fill.a);
}

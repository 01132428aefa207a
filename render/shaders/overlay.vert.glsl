// Symbols, labels and the heads-up display: quads in pixels, each at the depth of what it belongs to.
layout(location = 0) in vec3 position;         // pixels from the upper left corner, y downwards; depth
layout(location = 1) in vec2 atlas_coordinate; // 0..1
layout(location = 2) in vec4 vertex_colour;

out vec2 uv;
out vec4 fill;

void main() {
  uv = atlas_coordinate;
  fill = vertex_colour;
  gl_Position = vec4(2.0 * position.x * viewport_px.z - 1.0, 1.0 - 2.0 * position.y * viewport_px.w, position.z, 1.0);
}

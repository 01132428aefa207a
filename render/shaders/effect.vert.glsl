// Soft shapes: smoke, fire, light, trails, marks on the ground. Places come projected.
layout(location = 0) in vec4 clip;
layout(location = 1) in vec2 vertex_place;   // -1..1 across; along it 0, or -1..1 where it is round
layout(location = 2) in vec4 vertex_colour;  // straight alpha
layout(location = 3) in float vertex_shape;  // EffectInstance::Shape

out vec2 place;
out vec4 fill;
flat out float shape;

void main() {
  place = vertex_place;
  fill = vertex_colour;
  shape = vertex_shape;
  gl_Position = clip;
}

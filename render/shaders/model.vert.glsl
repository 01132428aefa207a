// One vertex of one moving object.
layout(location = 0) in vec3 position;         // metres in the body frame
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 vertex_colour;
layout(location = 3) in mat4 clip_from_body;   // 3..6, one an instance
layout(location = 7) in vec4 sun_body;         // unit vector; w: how much day there is
layout(location = 8) in vec4 veil;             // rgb: air added; a: share of the object's own light that is left

out vec3 lit;

void main() {
  gl_Position = clip_from_body * vec4(position, 1.0);
  float facing = dot(normal, sun_body.xyz);
  lit = vertex_colour * ((0.55 + 0.45 * facing) * sun_body.w * veil.a) + veil.rgb;
}

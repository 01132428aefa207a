// One vertex of one moving object.
layout(location = 0) in vec3 position;         // metres in the body frame: x forward, y right, z down
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 vertex_colour;    // a: the joint that it moves with (ModelJoint), in 255ths
layout(location = 3) in mat4 clip_from_body;   // 3..6, one an instance
layout(location = 7) in vec4 sun_body;         // unit vector; w: how much day there is
layout(location = 8) in vec4 veil;             // rgb: air added; a: share of the object's own light that is left
layout(location = 9) in vec4 joints;           // turret, gun, spin (radians); gear down or hatch shut (0..1)

layout(location = 0) uniform vec3 pivots[8];

out vec3 lit;

vec3 about_x(vec3 v, float a) { float c = cos(a), s = sin(a); return vec3(v.x, c * v.y - s * v.z, s * v.y + c * v.z); }
vec3 about_y(vec3 v, float a) { float c = cos(a), s = sin(a); return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); }
vec3 about_z(vec3 v, float a) { float c = cos(a), s = sin(a); return vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z); }

void main() {
  vec3 p = position;
  vec3 n = normal;
  int joint = int(vertex_colour.a * 255.0 + 0.5);
  if (joint != 0) {
    p -= pivots[joint];
    if (joint == 2) { p = about_y(p, joints.y); n = about_y(n, joints.y); }
    if (joint == 3) { p = about_z(p, joints.z); n = about_z(n, joints.z); }
    if (joint == 4) { p = about_y(p, 4.0 * joints.z); n = about_y(n, 4.0 * joints.z); }
    if (joint == 5) { p = about_x(p, 3.0 * joints.z); n = about_x(n, 3.0 * joints.z); }
    if (joint == 6) p *= joints.w;
    if (joint == 7) { p = about_y(p, 1.7 * (1.0 - joints.w)); n = about_y(n, 1.7 * (1.0 - joints.w)); }
    p += pivots[joint];
    if (joint <= 2 || joint == 7) {  // the gun and the hatch turn with the turret
      p = about_z(p - pivots[1], joints.x) + pivots[1];
      n = about_z(n, joints.x);
    }
  }
  gl_Position = clip_from_body * vec4(p, 1.0);
  float facing = dot(n, sun_body.xyz);
  lit = vertex_colour.rgb * ((0.55 + 0.45 * facing) * sun_body.w * veil.a) + veil.rgb;
}

// The sky along one ray from the eye: the air it meets, lit by the sun over the place where the ray comes lowest.
// A ray that climbs at sine m meets H / (m + c) of air; one that dips first meets the whole tangent path less that.
in vec3 ray;
layout(location = 0) out vec3 colour;

const float kCurve = 0.025;                    // 1 / kCurve scale heights is half of a level path

void main() {
  float shrink = inversesqrt(dot(ray, ray));
  float climb = dot(ray, eye_up_ecef.xyz) * shrink;
  float along_sun = dot(ray, sun_ecef.xyz) * shrink;
  float sun_at_eye = dot(eye_up_ecef.xyz, sun_ecef.xyz);
  float density = sun_ecef.w;
  float depth = density / (abs(climb) + kCurve);
  float sun_sine = sun_at_eye;
  if (climb < 0.0) {
    // Where the ray comes nearest to the Earth.
    float sine = sqrt(max(1.0 - climb * climb, 1e-6));
    float lowest_m = eye_scaled.w - eye_up_ecef.w * (1.0 - sine);
    depth = max(2.0 / kCurve * Density(lowest_m) - depth, 0.0);
    sun_sine = (sun_at_eye - climb * along_sun) / sine;
  }
  float day = DaySky(sun_sine);
  colour = Airlight(kZenithDepth * depth, kScatter) * SunColour(depth, sun_sine) * day;
  // The sun: a disc half a degree wide, and the light that air scatters around it.
  float off_sun = 1.0 - along_sun;
  float glow = 0.00004 / (off_sun + 0.00006);
  colour += vec3(1.0, 0.93, 0.80) * (glow * (0.3 + 0.7 * density));
}

// Light and air, plausible rather than measured. The air's density falls off with the scale height; what a path through
// it scatters towards the eye is 1 - exp(-k depth) with k growing towards blue, times how much day there is.
const float kEarthRadius_m = 6371000.0;
const float kScaleHeight_m = 8000.0;
const float kZenithDepth = 0.5;            // of the whole air, straight up, as the sky shows it
const float kGroundShare = 0.12;           // of that, as it veils the ground
const vec3 kScatter = vec3(0.42, 0.98, 2.30);
const vec3 kGroundScatter = vec3(0.70, 1.00, 1.60);  // whiter: near the ground there is haze
const vec3 kLowSun = vec3(1.00, 0.70, 0.46);
const vec3 kAirlight = vec3(0.80, 0.88, 0.97);
const float kNightLight = 0.12;            // the darkest ground

float Density(float height_m) { return exp2(-1.442695 / kScaleHeight_m * max(height_m, 0.0)); }
// sun_sine: sine of the sun's elevation.
float DayLight(float sun_sine) { return kNightLight + (1.0 - kNightLight) * smoothstep(-0.12, 0.30, sun_sine); }
float DaySky(float sun_sine) { return 0.02 + 0.98 * smoothstep(-0.20, 0.18, sun_sine); }
vec3 Airlight(float depth, vec3 scatter) { return kAirlight * (1.0 - exp2(-1.442695 * depth * scatter)); }
// Sunlight that grazes the Earth reddens; where there is more air, one sees more of that.
vec3 SunColour(float depth, float sun_sine) {
  float low = 1.0 - smoothstep(-0.05, 0.22, sun_sine);
  return mix(vec3(1.0), kLowSun, low * min(0.1 * depth, 1.0));
}

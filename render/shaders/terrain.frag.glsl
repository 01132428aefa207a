// Ground: images over each other, times light, plus air. LAYERn: 0 no image, or what the image does (LayerRole + 1);
// SINGLEn: it is of the pages with one channel; ADJUSTn: its opacity, gamma or multiplier are not all 1.
layout(binding = 0) uniform sampler2DArray colour_pages;
layout(binding = 1) uniform sampler2DArray overlay_pages;

in vec4 shade;
in vec4 uv01;
flat in vec3 pages;
#if LAYER2 != 0 || LAYER3 != 0
in vec4 uv23;
#endif
#if LAYER3 != 0 || LAYER4 != 0 || LAYER5 != 0
flat in vec3 more_pages;
#endif
#if LAYER4 != 0 || LAYER5 != 0
in vec4 uv45;
#endif
#if FADE
in vec4 from01;
flat in vec4 from_pages;
#endif
#if NIGHT
in float dark;                                 // share of a light on the ground that reaches the eye, by day none
#endif
#if TINT
flat in vec4 tint;
#endif
#if WATER
in vec3 to_eye;
in vec4 up_sun;                                // xyz: upwards; w: share of the sun's light that is mirrored and arrives
#endif
layout(location = 0) out vec3 colour;

const int kColour = 1, kGrey = 2, kMultiply = 3, kNight = 4;
const vec3 kBareGround = vec3(0.72, 0.73, 0.70);
const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);

vec3 ground = kBareGround;
vec3 lights = vec3(0.0);
float water = 0.0;

vec4 Texel(int single, vec2 uv, float page) {
  return single != 0 ? vec4(texture(overlay_pages, vec3(uv, page)).rrr, 1.0) : texture(colour_pages, vec3(uv, page));
}

#if FADE
// A share of `before` in the place of `texel`; each colour counts as much as it covers.
vec4 Blend(vec4 texel, vec4 before, float share) {
  vec4 sum = mix(vec4(texel.rgb * texel.a, texel.a), vec4(before.rgb * before.a, before.a), share);
  return vec4(sum.rgb / max(sum.a, 1.0e-3), sum.a);
}
#define FADING(single, uv, page, from_uv, from_page, share) \
  Blend(Texel(single, uv, page), Texel(single, from_uv, from_page), share)
#else
#define FADING(single, uv, page, from_uv, from_page, share) Texel(single, uv, page)
#endif

// role, single and adjusted are constants where it is called.
void Lay(int role, int single, int adjusted, vec4 texel, vec4 how) {
  if (role == kGrey) texel.rgb = vec3(dot(texel.rgb, kLuminance));
  float opacity = 1.0;
  if (adjusted != 0) {
    opacity = how.x;
    texel.rgb = how.z * pow(texel.rgb, vec3(how.y));
  }
  if (role == kColour || role == kGrey) {
    ground = mix(ground, texel.rgb, texel.a * opacity);
  } else if (role == kMultiply) {
    ground *= adjusted != 0 ? mix(0.5, texel.r, opacity) : texel.r;
  } else if (role == kNight) {
    lights += opacity * texel.a * texel.rgb;
  } else {
    water = opacity * texel.r;
  }
}

#if WATER
// The sun in waves. Share of the facets that mirror it towards the eye: Cox and Munk, "Measurement of the roughness of
// the sea surface from photographs of the sun's glitter" (1954), for a fresh breeze; Fresnel's share as Schlick has it.
float Glint() {
  const float kMeanSquareSlope = 0.03;
  vec3 eye = normalize(to_eye);
  vec3 up = normalize(up_sun.xyz);
  vec3 facet = normalize(eye + sun_ecef.xyz);
  float c = max(dot(up, facet), 0.05);
  float tan2 = 1.0 / (c * c) - 1.0;
  float slopes = exp2(-1.442695 * tan2 / kMeanSquareSlope) / (kMeanSquareSlope * c * c * c * c);
  float f = 1.0 - max(dot(facet, eye), 0.0);
  float fresnel = 0.02 + 0.98 * f * f * f * f * f;
  // The eye, or a film, gives way to what is very bright.
  return 1.0 - exp2(-0.8 * fresnel * slopes / (4.0 * max(dot(up, eye), 0.15)));
}
#endif

void main() {
#if LAYER0 != 0
  Lay(LAYER0, SINGLE0, ADJUST0, FADING(SINGLE0, uv01.xy, pages.x, from01.xy, from_pages.x, from_pages.z), layers[0]);
#endif
#if LAYER1 != 0
  Lay(LAYER1, SINGLE1, ADJUST1, FADING(SINGLE1, uv01.zw, pages.y, from01.zw, from_pages.y, from_pages.w), layers[1]);
#endif
#if LAYER2 != 0
  Lay(LAYER2, SINGLE2, ADJUST2, Texel(SINGLE2, uv23.xy, pages.z), layers[2]);
#endif
#if LAYER3 != 0
  Lay(LAYER3, SINGLE3, ADJUST3, Texel(SINGLE3, uv23.zw, more_pages.x), layers[3]);
#endif
#if LAYER4 != 0
  Lay(LAYER4, SINGLE4, ADJUST4, Texel(SINGLE4, uv45.xy, more_pages.y), layers[4]);
#endif
#if LAYER5 != 0
  Lay(LAYER5, SINGLE5, ADJUST5, Texel(SINGLE5, uv45.zw, more_pages.z), layers[5]);
#endif
  colour = ground * shade.x + shade.yzw;
#if NIGHT
  colour += lights * dark;
#endif
#if WATER
  if (water > 0.01) colour += vec3(1.0, 0.95, 0.85) * (water * up_sun.w * Glint());
#endif
#if TINT
  colour = mix(colour, tint.rgb * (0.4 + 0.8 * dot(colour, kLuminance)), tint.a);
#endif
}

// One terrain vertex. Its position depends on its number and the view alone, never on the quadnode that is drawn with it: that, and `invariant`, is what makes neighbours meet without a gap.
layout(location = 0) in vec3 position;         // metres in the frame of the vertex's page
layout(location = 1) in vec2 octahedral;       // outward normal in the same frame
layout(location = 2) in uint place;            // quadnode << 15 | post
layout(location = 3) in float rise_m;          // over its place when the list was made
layout(location = 4) in uint draw_number;      // one a draw (base instance)

const uint kPosts = 129u;
const float kFade_s = 0.3;                     // as in managers/image_fade.h
const uint kNorthPole = 0x80000000u;

struct FrameRow {
  mat4 clip_from_frame;
  vec4 scaled_from_frame[3];                   // rows of a 3x4 matrix: scaled space from the frame
  vec4 earth_centre;                           // in the frame
};
struct DrawRow {
  uvec2 south_west;
  uvec2 post_spacing;
  uint frame;
  float per_rise_s;
  vec2 per_grid_unit;                          // 1 / sides of the quadnode
  vec2 fade_s;                                 // for how long its lowest images are still blended in
  float from_page[2];                          // array layers
  uvec4 tints;                                 // by error, level, frame and image
  vec4 from[2];                                // what those are blended in over; as image
  vec4 image[6];                               // offset u, offset v, scale u, scale v
  float image_page[6];                         // array layers
};
layout(std430, binding = 0) readonly buffer Frames { FrameRow frames[]; };
layout(std430, binding = 1) readonly buffer Draws { DrawRow draws[]; };

invariant gl_Position;
// Few and full: what a software renderer pays for a small triangle grows with the number of these.
out vec4 shade;                                // x: what the ground's colour is multiplied by; yzw: air added to it
out vec4 uv01;
flat out vec3 pages;
#if LAYER2 != 0 || LAYER3 != 0
out vec4 uv23;
#endif
#if LAYER3 != 0 || LAYER4 != 0 || LAYER5 != 0
flat out vec3 more_pages;
#endif
#if LAYER4 != 0 || LAYER5 != 0
out vec4 uv45;
#endif
#if NIGHT
out float dark;
#endif
#if FADE
out vec4 from01;
flat out vec4 from_pages;                      // array layers, and how much of them is left
#endif
#if TINT
flat out vec4 tint;
#endif
#if WATER
out vec3 to_eye;
out vec4 up_sun;
#endif

vec3 NormalInFrame() {
  vec3 n = vec3(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}

vec2 ImageCoordinate(vec4 image, vec2 local) { return (4.0 + 248.0 * (image.xy + image.zw * local)) * (1.0 / 256.0); }

void main() {
  uint own = place >> 15;
  uint post = place & 0x7FFFu;
  uint row = post / kPosts;
  uint frame = draws[own].frame;
  // On its way from where the surface was before.
  float left = clamp(1.0 - moment.x * draws[own].per_rise_s, 0.0, 1.0);
  vec3 here = position + (rise_m * left) * normalize(position - frames[frame].earth_centre.xyz);
  gl_Position = frames[frame].clip_from_frame * vec4(here, 1.0);

  uvec2 grid = draws[own].south_west + draws[own].post_spacing * uvec2(post - row * kPosts, row);
  vec2 local = clamp(vec2(grid - draws[draw_number].south_west) * draws[draw_number].per_grid_unit, 0.0, 1.0);
  // A pole is a point of every meridian.
  if (grid.y == 0u || grid.y == kNorthPole) local.x = 0.5;

  vec3 scaled = vec3(dot(frames[frame].scaled_from_frame[0], vec4(here, 1.0)),
                     dot(frames[frame].scaled_from_frame[1], vec4(here, 1.0)),
                     dot(frames[frame].scaled_from_frame[2], vec4(here, 1.0)));
  float radius = length(scaled);
  float height_m = (radius - 1.0) * kEarthRadius_m;
  vec3 up = scaled / radius;                   // of the scaled sphere: within 0.2 degrees of the geodetic one
  float sun_sine = dot(up, sun_ecef.xyz);
  float day = DayLight(sun_sine);

#if SLOPES
  // Flat ground is as bright as under an image; slopes towards the sun brighter, those away from it darker.
  vec3 n = NormalInFrame();
  vec3 normal = normalize(vec3(dot(frames[frame].scaled_from_frame[0].xyz, n), dot(frames[frame].scaled_from_frame[1].xyz, n),
                               dot(frames[frame].scaled_from_frame[2].xyz, n)));
  vec3 sun = sun_sine > 0.25 ? sun_ecef.xyz : normalize(sun_ecef.xyz + (0.25 - sun_sine) * up);
  day *= clamp(1.0 + 1.1 * (dot(normal, sun) - dot(up, sun)), 0.35, 1.4);
#endif

  // Air between the ground and the eye: the density met, averaged over the way, and never more than the curved air holds.
  vec3 eyewards = eye_scaled.xyz - scaled;
  float distance_m = length(eyewards) * kEarthRadius_m;
  float climb = (eye_scaled.w - height_m) * (1.0 / kScaleHeight_m);
  float density = Density(height_m);
  float mean_share = abs(climb) < 0.05 ? 1.0 : (1.0 - exp2(-1.442695 * climb)) / climb;
  float rise = dot(up, eyewards) * kEarthRadius_m / max(distance_m, 1.0);
  float path_m = min(distance_m * mean_share, kScaleHeight_m / (max(rise, 0.0) + 0.012));
  float depth = kGroundShare * kZenithDepth / kScaleHeight_m * density * path_m;
  vec3 veil = Airlight(depth, kGroundScatter);
  day *= float(1 << MULTIPLIERS);              // a layer of 0.5 that multiplies leaves the colour as it is
  shade = vec4(day * (1.0 - veil.g), veil * SunColour(8.0 * depth, sun_sine) * DaySky(sun_sine));

  uv01 = vec4(ImageCoordinate(draws[draw_number].image[0], local), ImageCoordinate(draws[draw_number].image[1], local));
#if LAYER2 != 0 || LAYER3 != 0
  uv23 = vec4(ImageCoordinate(draws[draw_number].image[2], local), ImageCoordinate(draws[draw_number].image[3], local));
#endif
#if LAYER3 != 0 || LAYER4 != 0 || LAYER5 != 0
  more_pages = vec3(draws[draw_number].image_page[3], draws[draw_number].image_page[4], draws[draw_number].image_page[5]);
#endif
#if LAYER4 != 0 || LAYER5 != 0
  uv45 = vec4(ImageCoordinate(draws[draw_number].image[4], local), ImageCoordinate(draws[draw_number].image[5], local));
#endif
#if NIGHT
  dark = smoothstep(-0.08, 0.12, -sun_sine) * (1.0 - veil.g);  // lights are on from a little before sunset
#endif
#if WATER
  to_eye = eyewards;
  up_sun = vec4(up, smoothstep(0.0, 0.08, sun_sine) * (1.0 - veil.g));
#endif
#if FADE
  from01 = vec4(ImageCoordinate(draws[draw_number].from[0], local), ImageCoordinate(draws[draw_number].from[1], local));
  from_pages = vec4(draws[draw_number].from_page[0], draws[draw_number].from_page[1],
                    clamp((draws[draw_number].fade_s - moment.x) / kFade_s, 0.0, 1.0));
#endif
#if TINT
  tint = unpackUnorm4x8(draws[draw_number].tints[int(moment.y)]);
#endif
  pages = vec3(draws[draw_number].image_page[0], draws[draw_number].image_page[1], draws[draw_number].image_page[2]);
}

// Ground: images over each other, times light, plus air. LAYERn: 0 no image, 1 colour, 2 overlay.
layout(binding = 0) uniform sampler2DArray colour_pages;
layout(binding = 1) uniform sampler2DArray overlay_pages;

in vec4 shade;
in vec4 uv01;
flat in vec3 pages;
#if LAYER2 != 0
in vec2 uv2;
#endif
layout(location = 0) out vec3 colour;

const vec3 kBareGround = vec3(0.72, 0.73, 0.70);

void main() {
  vec3 ground = kBareGround;
  vec4 texel;
#if LAYER0 == 1
  texel = texture(colour_pages, vec3(uv01.xy, pages.x));
  ground = mix(ground, texel.rgb, texel.a);
#elif LAYER0 == 2
  ground *= texture(overlay_pages, vec3(uv01.xy, pages.x)).r;
#endif
#if LAYER1 == 1
  texel = texture(colour_pages, vec3(uv01.zw, pages.y));
  ground = mix(ground, texel.rgb, texel.a);
#elif LAYER1 == 2
  ground *= texture(overlay_pages, vec3(uv01.zw, pages.y)).r;
#endif
#if LAYER2 == 1
  texel = texture(colour_pages, vec3(uv2, pages.z));
  ground = mix(ground, texel.rgb, texel.a);
#elif LAYER2 == 2
  ground *= texture(overlay_pages, vec3(uv2, pages.z)).r;
#endif
  colour = ground * shade.x + shade.yzw;
}

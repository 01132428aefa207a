in vec2 place;
in vec4 fill;
flat in float shape;
layout(location = 0) out vec4 colour;  // premultiplied; alpha 0 adds light

void main() {
  float square = dot(place, place);
  if (square >= 1.0) discard;
  float soft = 1.0 - square;
  if (shape == 1.0) {  // glow
    colour = vec4(fill.rgb * (fill.a * soft * soft * (1.0 + soft)), 0.0);
    return;
  }
  float cover = shape == 0.0 ? soft * soft * (3.0 - 2.0 * soft) : smoothstep(0.0, shape == 3.0 ? 0.6 : 0.4, soft);
  float alpha = fill.a * cover;
  colour = vec4(fill.rgb * alpha, alpha);
}

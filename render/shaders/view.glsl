// What every shader of a view knows. Scaled space: ECEF divided by the axes of the ellipsoid, which becomes a unit sphere.
layout(std140, binding = 0) uniform ViewBlock {
  vec4 sun_ecef;         // xyz: unit vector to the sun; w: density of the air at the eye, 1 at the ground
  vec4 eye_scaled;       // xyz: the eye in scaled space; w: its height above the ellipsoid, metres
  vec4 eye_up_ecef;      // xyz: geodetic up at the eye; w: distance from the Earth's centre, metres
  vec4 ray_ecef[3];      // directions at clip (-1,-1), (3,-1), (-1,3)
  vec4 viewport_px;      // width, height, 1 / width, 1 / height
  vec4 moment;           // x: seconds since the terrain list was made; y: which tint
  vec4 layers[6];        // x: opacity, y: gamma, z: multiplier of each image layer
};

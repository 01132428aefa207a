// WGS 84: between geodetic and ECEF coordinates, in double.
//
// Units and frames: units.h. Geodesy that is not on a hot path goes through GeographicLib; ToEcef is the closed form,
// which GeographicLib's own agrees with to the last few bits, and which the terrain server calls for every post.
// Threads: pure functions.
#pragma once

#include "runtime/earth/units.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace belvedere {

inline constexpr double kEquatorialRadius_m = 6378137.0;
inline constexpr double kFlattening = 1.0 / 298.257223563;
inline constexpr double kPolarRadius_m = kEquatorialRadius_m * (1.0 - kFlattening);
inline constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);

glm::dvec3 ToEcef(const Geodetic& position);
Geodetic ToGeodetic(const glm::dvec3& ecef);

// Outward normal of the ellipsoid at a latitude and longitude: the geodetic "up".
glm::dvec3 UpAt(double latitude_deg, double longitude_deg);

// Axes of the local level frame at a position: right-handed east, north, up.
struct LevelAxes {
  glm::dvec3 east, north, up;
};
LevelAxes LevelAxesAt(double latitude_deg, double longitude_deg);

// Metres of a degree east, x, and north, y, on the ellipsoid: its radii of curvature there.
glm::dvec2 MetresPerDegree(double latitude_deg);

// Distance in metres from an eye to the horizon of a sphere of the polar radius; 0 at or under the surface.
double HorizonDistance(double height_m);

}  // namespace belvedere

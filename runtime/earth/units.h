// Angles, pixels and geodetic positions as types of their own, so that a degree is never taken for a radian.
//
// Units: Radians in radians, metres as double in names that end in _m, Pixels in pixels.
// Frames: Geodetic is WGS 84; latitude [-90, 90] degrees north, longitude degrees east, height_m above the ellipsoid.
//         ECEF is x towards (0 N, 0 E), y towards (0 N, 90 E), z towards the north pole; glm::dvec3, metres.
#pragma once

#include <glm/vec3.hpp>

#include <compare>
#include <numbers>

namespace belvedere {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

struct Radians {
  double value = 0;
  constexpr double degrees() const { return value * kDegreesPerRadian; }
  static constexpr Radians FromDegrees(double degrees) { return {degrees * kRadiansPerDegree}; }
  constexpr auto operator<=>(const Radians&) const = default;
};

struct Geodetic {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;
  constexpr bool operator==(const Geodetic&) const = default;
};

}  // namespace belvedere

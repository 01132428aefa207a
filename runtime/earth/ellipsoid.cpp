#include "runtime/earth/ellipsoid.h"

#include <GeographicLib/Geocentric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {

glm::dvec3 ToEcef(const Geodetic& position) {
  const glm::dvec3 up = UpAt(position.latitude_deg, position.longitude_deg);
  const double prime_vertical_radius = kEquatorialRadius_m / std::sqrt(1.0 - kEccentricitySquared * up.z * up.z);
  const double horizontal = prime_vertical_radius + position.height_m;
  return {horizontal * up.x, horizontal * up.y,
          (prime_vertical_radius * (1.0 - kEccentricitySquared) + position.height_m) * up.z};
}

Geodetic ToGeodetic(const glm::dvec3& ecef) {
  Geodetic position;
  GeographicLib::Geocentric::WGS84().Reverse(ecef.x, ecef.y, ecef.z, position.latitude_deg, position.longitude_deg,
                                             position.height_m);
  return position;
}

glm::dvec3 UpAt(double latitude_deg, double longitude_deg) {
  const double latitude = latitude_deg * kRadiansPerDegree;
  const double longitude = longitude_deg * kRadiansPerDegree;
  // At the poles cos(latitude) is a rounding error that would give each longitude a pole of its own.
  const double cos_latitude = std::abs(latitude_deg) == 90.0 ? 0.0 : std::cos(latitude);
  return {cos_latitude * std::cos(longitude), cos_latitude * std::sin(longitude), std::sin(latitude)};
}

LevelAxes LevelAxesAt(double latitude_deg, double longitude_deg) {
  const double latitude = latitude_deg * kRadiansPerDegree;
  const double longitude = longitude_deg * kRadiansPerDegree;
  const glm::dvec3 east{-std::sin(longitude), std::cos(longitude), 0.0};
  const glm::dvec3 north{-std::sin(latitude) * std::cos(longitude), -std::sin(latitude) * std::sin(longitude),
                         std::cos(latitude)};
  return {east, north, UpAt(latitude_deg, longitude_deg)};
}

glm::dvec2 MetresPerDegree(double latitude_deg) {
  const double sine = std::sin(latitude_deg * kRadiansPerDegree), cosine = std::cos(latitude_deg * kRadiansPerDegree);
  const double w = std::sqrt(1 - kEccentricitySquared * sine * sine);
  const double meridian_m = kEquatorialRadius_m * (1 - kEccentricitySquared) / (w * w * w);
  return kRadiansPerDegree * glm::dvec2(kEquatorialRadius_m / w * cosine, meridian_m);
}

double HorizonDistance(double height_m) {
  const double height = std::max(height_m, 0.0);
  return std::sqrt(height * (2.0 * kPolarRadius_m + height));
}

}  // namespace belvedere

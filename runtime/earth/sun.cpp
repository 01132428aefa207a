#include "runtime/earth/sun.h"

#include "runtime/earth/units.h"

#include <cmath>

namespace belvedere {

glm::dvec3 SunDirectionEcef(double utc_s) {
  constexpr double kSecondsPerDay = 86400.0;
  constexpr double kDaysFrom1970ToJ2000 = 10957.5;  // J2000 is 2000-01-01 12:00
  const double days = utc_s / kSecondsPerDay - kDaysFrom1970ToJ2000;

  const double mean_longitude_deg = 280.460 + 0.9856474 * days;
  const double mean_anomaly = (357.528 + 0.9856003 * days) * kRadiansPerDegree;
  const double ecliptic_longitude =
      (mean_longitude_deg + 1.915 * std::sin(mean_anomaly) + 0.020 * std::sin(2.0 * mean_anomaly)) * kRadiansPerDegree;
  const double obliquity = (23.439 - 0.0000004 * days) * kRadiansPerDegree;

  // Equatorial, of date; then turned by the Greenwich mean sidereal time.
  const double x = std::cos(ecliptic_longitude);
  const double y = std::cos(obliquity) * std::sin(ecliptic_longitude);
  const double z = std::sin(obliquity) * std::sin(ecliptic_longitude);
  const double sidereal_deg = std::fmod(280.46061837 + 360.98564736629 * days, 360.0);
  const double turn = sidereal_deg * kRadiansPerDegree;
  return {std::cos(turn) * x + std::sin(turn) * y, -std::sin(turn) * x + std::cos(turn) * y, z};
}

}  // namespace belvedere

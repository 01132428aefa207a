#include "runtime/earth/sun.h"

#include "runtime/earth/units.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace belvedere {
namespace {

double DeclinationDeg(double utc_s) {
  return std::asin(SunDirectionEcef(utc_s).z) * kDegreesPerRadian;
}
double LongitudeDeg(double utc_s) {
  const glm::dvec3 sun = SunDirectionEcef(utc_s);
  return std::atan2(sun.y, sun.x) * kDegreesPerRadian;
}

TEST(Sun, IsAUnitVector) {
  for (int day = -10000; day < 30000; day += 777) EXPECT_NEAR(glm::length(SunDirectionEcef(day * 86400.0)), 1.0, 1e-12);
}

TEST(Sun, DeclinationAsPublished) {
  EXPECT_NEAR(DeclinationDeg(718934400), -7.785, 0.02);   // 1992-10-13 00:00, Meeus, example 25.a
  EXPECT_NEAR(DeclinationDeg(1710903960), 0.0, 0.02);     // equinox of 2024-03-20 03:06
  EXPECT_NEAR(DeclinationDeg(1718916660), 23.436, 0.01);  // solstice of 2024-06-20 20:51
}

// At noon UTC the sun stands over the meridian that the equation of time says: 4 minutes of time a degree.
TEST(Sun, StandsWhereTheEquationOfTimeSays) {
  EXPECT_NEAR(LongitudeDeg(1730635200), -16.4 / 4, 0.1);  // 2024-11-03: sundials are 16.4 minutes fast
  EXPECT_NEAR(LongitudeDeg(1707652800), 14.2 / 4, 0.1);   // 2024-02-11: 14.2 minutes slow
}

TEST(Sun, GoesWestOncePerDay) {
  const double noon = 1730635200;
  EXPECT_NEAR(LongitudeDeg(noon + 6 * 3600), LongitudeDeg(noon) - 90, 0.1);
  EXPECT_NEAR(LongitudeDeg(noon + 86400), LongitudeDeg(noon), 0.1);
}

}  // namespace
}  // namespace belvedere

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <GeographicLib/Geocentric.hpp>
#include <glm/geometric.hpp>

#include <random>

namespace belvedere {
namespace {

glm::dvec3 Reference(const Geodetic& position) {
  glm::dvec3 ecef;
  GeographicLib::Geocentric::WGS84().Forward(position.latitude_deg, position.longitude_deg, position.height_m, ecef.x,
                                             ecef.y, ecef.z);
  return ecef;
}

TEST(Ellipsoid, AgreesWithGeographicLib) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> latitude(-90, 90), longitude(-180, 180), height(-11'000, 1e7);
  for (int i = 0; i < 5000; ++i) {
    const Geodetic position{latitude(random), longitude(random), height(random)};
    EXPECT_LT(glm::distance(ToEcef(position), Reference(position)), 1e-8);
  }
}

TEST(Ellipsoid, KnowsItsAxes) {
  EXPECT_LT(glm::distance(ToEcef({0, 0, 0}), glm::dvec3(kEquatorialRadius_m, 0, 0)), 1e-9);
  EXPECT_LT(glm::distance(ToEcef({0, 90, 0}), glm::dvec3(0, kEquatorialRadius_m, 0)), 1e-9);
  EXPECT_NEAR(kPolarRadius_m, 6356752.314245, 1e-6);
  // A pole is one point, whatever the longitude.
  for (const double longitude : {-180.0, -33.0, 0.0, 90.0, 180.0}) {
    EXPECT_EQ(ToEcef({90, longitude, 0}), glm::dvec3(0, 0, ToEcef({90, 0, 0}).z));
    EXPECT_EQ(ToEcef({-90, longitude, 5}), glm::dvec3(0, 0, ToEcef({-90, 0, 5}).z));
  }
}

TEST(Ellipsoid, GeodeticRoundTrips) {
  for (const Geodetic position :
       {Geodetic{37.2, -118.3, 1200}, {-89.999, 12, 2800}, {0, 179.999, -50}, {45, 0, 35'000'000}}) {
    const Geodetic back = ToGeodetic(ToEcef(position));
    EXPECT_NEAR(back.latitude_deg, position.latitude_deg, 1e-12);
    EXPECT_NEAR(back.longitude_deg, position.longitude_deg, 1e-10);
    EXPECT_NEAR(back.height_m, position.height_m, 1e-6);
  }
}

TEST(Ellipsoid, LevelAxesAreRightHandedAndPointWhereTheySay) {
  for (const Geodetic position : {Geodetic{0, 0, 0}, {37, -118, 0}, {-60, 170, 0}, {89.9, 45, 0}}) {
    const LevelAxes axes = LevelAxesAt(position.latitude_deg, position.longitude_deg);
    EXPECT_LT(glm::distance(glm::cross(axes.east, axes.north), axes.up), 1e-14);
    const glm::dvec3 here = ToEcef(position);
    const glm::dvec3 above = ToEcef({position.latitude_deg, position.longitude_deg, 100});
    EXPECT_LT(glm::distance((above - here) / 100.0, axes.up), 1e-9);
    const glm::dvec3 northwards = ToEcef({position.latitude_deg + 1e-4, position.longitude_deg, 0}) - here;
    EXPECT_GT(glm::dot(glm::normalize(northwards), axes.north), 0.999999);
  }
}

// Against the distance between two points that are a ten-thousandth of a degree apart.
TEST(Ellipsoid, MetresPerDegree) {
  constexpr double kStep_deg = 1e-4;
  for (const double latitude_deg : {-89.0, -60.0, -12.5, 0.0, 45.0, 80.0}) {
    const glm::dvec2 metres = MetresPerDegree(latitude_deg);
    const glm::dvec3 here = Reference({latitude_deg, 20, 0});
    EXPECT_NEAR(metres.x, glm::distance(here, Reference({latitude_deg, 20 + kStep_deg, 0})) / kStep_deg, 0.1);
    EXPECT_NEAR(metres.y,
                glm::distance(Reference({latitude_deg - kStep_deg / 2, 20, 0}),
                              Reference({latitude_deg + kStep_deg / 2, 20, 0})) /
                    kStep_deg,
                0.1);
  }
  EXPECT_NEAR(MetresPerDegree(90).x, 0, 1e-9);
}

TEST(Ellipsoid, HorizonDistance) {
  EXPECT_EQ(HorizonDistance(-5), 0);
  EXPECT_EQ(HorizonDistance(0), 0);
  EXPECT_NEAR(HorizonDistance(1.7), 4649, 10);
  EXPECT_NEAR(HorizonDistance(10'000), 356'700, 200);
}

}  // namespace
}  // namespace belvedere

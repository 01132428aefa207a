#include "preproc/types/surface_properties.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace belvedere {
namespace {

// Heights in metres by longitude and latitude.
ElevationPage PageOf(Quadcode node, const std::function<double(double, double)>& height_m) {
  ElevationPage page;
  const GeoBox box = node.Box();
  for (int row = -kApron; row < kPosts + kApron; ++row) {
    for (int column = -kApron; column < kPosts + kApron; ++column) {
      const double step_deg = node.HeightDegrees() / kCells;
      page.heights_mm.push_back(static_cast<int32_t>(
          std::lrint(1000 * height_m(box.west_deg + column * step_deg, box.south_deg + row * step_deg))));
    }
  }
  return page;
}

const Quadcode kNode = Quadcode::Containing(45.3, 10.2, 10);

// Rises 1 m in 2 m towards the north: 26.57 degrees.
double Ramp(double, double latitude_deg) {
  const double metres_per_degree = 111132.95 - 559.8 * std::cos(2 * 45.3 * kRadiansPerDegree);
  return 0.5 * metres_per_degree * (latitude_deg - 45.3);
}

TEST(SurfaceProperties, ARampHasItsSlopeNormalAndNoRoughness) {
  const ElevationPage page = PageOf(kNode, Ramp);
  const double angle_deg = std::atan(0.5) / kRadiansPerDegree;
  const auto slopes = SlopeAngles(page, kNode);
  const auto normals = NormalMap(page, kNode);
  const auto roughness = Roughness(page, kNode);
  ASSERT_EQ(normals->channels, 3);
  for (const int at : {-2, 0, 64, 130}) {
    EXPECT_NEAR(slopes->at(0, at, at) / 2.0, angle_deg, 0.5);
    EXPECT_NEAR(normals->at(0, at, at) / 127.5 - 1, 0, 0.01);
    EXPECT_NEAR(normals->at(1, at, at) / 127.5 - 1, -std::sin(angle_deg * kRadiansPerDegree), 0.01);
    EXPECT_NEAR(normals->at(2, at, at) / 127.5 - 1, std::cos(angle_deg * kRadiansPerDegree), 0.01);
    EXPECT_EQ(roughness->at(0, at, at), 0);
  }
}

TEST(SurfaceProperties, RoughnessIsTheDeviationFromThePlane) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 10);
  const ElevationPage page =
      PageOf(kNode, [&](double longitude, double latitude) { return Ramp(longitude, latitude) + noise(random); });
  const auto roughness = Roughness(page, kNode);
  double sum = 0;
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) sum += roughness->at(0, column, row) / 4.0;
  }
  // 9 values less the 3 that the plane takes: sqrt(6 / 9) of the noise, and a little less on the mean.
  EXPECT_NEAR(sum / (kPosts * kPosts), 10 * std::sqrt(6.0 / 9), 0.6);
}

TEST(SurfaceProperties, WaterIsWhatLiesAtSeaLevelOrBelow) {
  const auto sea = Geoid::LoadEgm96();
  ASSERT_TRUE(sea.ok()) << sea.message();
  const double shore_deg = kNode.Box().west_deg + kNode.HeightDegrees() / 2;
  const ElevationPage page = PageOf(kNode, [&](double longitude, double latitude) {
    return (*sea)->Height(latitude, longitude) + (longitude > shore_deg          ? 20.0
                                                  : longitude > shore_deg - 0.01 ? 0.0
                                                                                 : -300.0);
  });
  const auto water = WaterMask(page, kNode, **sea);
  EXPECT_EQ(water->at(0, 10, 64), 1);
  EXPECT_EQ(water->at(0, 50, 64), 1);
  EXPECT_EQ(water->at(0, 80, 64), 0);
}

TEST(SurfaceProperties, NeighboursAgreeWhereTheyMeet) {
  const auto height = [](double longitude, double latitude) {
    return 900 * std::sin(40 * longitude) * std::cos(55 * latitude);
  };
  const Quadcode east = Quadcode::FromColumnRow(kNode.level(), kNode.column() + 1, kNode.row());
  const ElevationPage here = PageOf(kNode, height), there = PageOf(east, height);
  const auto a = SlopeAngles(here, kNode), b = SlopeAngles(there, east);
  for (int row = -1; row < kPosts + 1; ++row) {
    for (int column = -1; column <= 1; ++column)
      EXPECT_EQ(a->at(0, kCells + column, row), b->at(0, column, row)) << column << " " << row;
  }
}

TEST(SurfaceProperties, PolesAreNoWalls) {
  const Quadcode pole = Quadcode::Containing(89.99, 3, 8);
  const ElevationPage page = PageOf(pole, [](double, double) { return 100.0; });
  const auto slopes = SlopeAngles(page, pole);
  for (const uint8_t value : slopes->values) ASSERT_EQ(value, 0);
}

}  // namespace
}  // namespace belvedere

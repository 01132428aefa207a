#include "servers/slope_tint.h"

#include "runtime/earth/post_grid.h"
#include "runtime/earth/units.h"
#include "tests/servers/image_test_pages.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

// The middle of a page whose ground rises evenly to the east.
Rgba TintOf(double steepness_deg, double latitude_deg = 47) {
  const Quadcode node = Quadcode::Containing(latitude_deg, 8, 12);
  const GeoBox box = node.Box();
  const RowGeometry geometry = RowAt(0.5 * (box.south_deg + box.north_deg));
  const double metres_a_degree = kRadiansPerDegree * geometry.prime_vertical_m * geometry.cos_latitude;
  const double rise = std::tan(steepness_deg * kRadiansPerDegree) * metres_a_degree;
  const auto heights = MakeElevation(node, [&](GridPoint p) { return rise * (p.longitude_deg() - box.west_deg); });
  return RgbaAt(*TintSlopes(*heights, node), 128, 128);
}

void ExpectNear(const Rgba& tint, const Rgba& expected) {
  for (size_t i = 0; i < tint.size(); ++i) EXPECT_NEAR(tint[i], expected[i], 3);
}

TEST(SlopeTint, IsThatOfTheTrueSlope) {
  ExpectNear(TintOf(0), {226, 232, 220, 255});
  ExpectNear(TintOf(5), {150, 200, 115, 255});
  ExpectNear(TintOf(20), {240, 150, 48, 255});
  ExpectNear(TintOf(20, 70), {240, 150, 48, 255});
  ExpectNear(TintOf(30), {208, 50, 40, 255});
  ExpectNear(TintOf(60), {92, 18, 70, 255});
}

TEST(SlopeTint, HasNoSteps) {
  Rgba before = TintOf(0);
  for (double steepness_deg = 0.5; steepness_deg < 45; steepness_deg += 0.5) {
    const Rgba tint = TintOf(steepness_deg);
    for (size_t i = 0; i < tint.size(); ++i) EXPECT_NEAR(tint[i], before[i], 14) << steepness_deg;
    before = tint;
  }
}

TEST(SlopeTint, GoesOnOverBorders) {
  const Quadcode node = Quadcode::Containing(44, 9.99, 9);
  const auto page = TintSlopes(*MakeElevation(node, WavyHeight), node);
  const Quadcode east = Quadcode::FromColumnRow(9, node.column() + 1, node.row());
  ExpectNoSeam(*page, *TintSlopes(*MakeElevation(east, WavyHeight), east), false, 2);
}

}  // namespace
}  // namespace belvedere

#include "servers/water_mask.h"

#include "tests/servers/image_test_pages.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

const Quadcode kNode = Quadcode::Containing(30, -40, 10);

int Middle(const ImagePage& page) {
  return page.texels[128 * kImageSide + 128];
}
int MaskOf(double height_m, const Geoid* sea = nullptr) {
  return Middle(*MaskWater(*MakeElevation(kNode, [&](GridPoint) { return height_m; }), kNode, sea));
}

TEST(WaterMask, StepsSoftlyFromSeaToLand) {
  EXPECT_EQ(MaskOf(-3000), 255);
  EXPECT_EQ(MaskOf(0), 255);
  EXPECT_NEAR(MaskOf(kShore_m / 2), 128, 1);
  EXPECT_EQ(MaskOf(kShore_m), 0);
  EXPECT_EQ(MaskOf(3000), 0);
}

TEST(WaterMask, TheSeaIsThatOfTheGeoid) {
  const auto sea = Geoid::LoadEgm96();
  ASSERT_TRUE(sea.ok()) << sea.message();
  const GeoBox box = kNode.Box();
  const double sea_m = (*sea)->Height(0.5 * (box.south_deg + box.north_deg), 0.5 * (box.west_deg + box.east_deg));
  ASSERT_GT(std::abs(sea_m), 10);
  EXPECT_EQ(MaskOf(sea_m - 1, sea->get()), 255);
  EXPECT_EQ(MaskOf(sea_m + 6, sea->get()), 0);
}

TEST(WaterMask, APitInLandIsNoSea) {
  const auto deep = [&](double around_m) {
    auto heights = MakeElevation(kNode, [&](GridPoint) { return around_m; });
    heights->heights_mm[static_cast<size_t>((64 + kApron) * kElevationSide + 64 + kApron)] = -2000;
    return Middle(*MaskWater(*heights, kNode, nullptr));  // the texel at post 64.3
  };
  EXPECT_EQ(deep(50), 0);
  EXPECT_EQ(deep(-2), 255);
}

TEST(WaterMask, GoesOnOverBorders) {
  const auto coast = [](GridPoint p) { return WavyHeight(p) - 1500; };
  const Quadcode node = Quadcode::Containing(44, 9.99, 5);
  const Quadcode north = Quadcode::FromColumnRow(5, node.column(), node.row() + 1);
  const auto page = MaskWater(*MakeElevation(node, coast), node, nullptr);
  EXPECT_EQ(page->format, ImageFormat::kR8);
  ExpectNoSeam(*page, *MaskWater(*MakeElevation(north, coast), north, nullptr), true, 1);
}

}  // namespace
}  // namespace belvedere

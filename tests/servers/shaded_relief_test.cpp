#include "servers/shaded_relief.h"

#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

constexpr int kOuter = kImageSide - 1;

int Texel(const ImagePage& page, int column, int row) {
  return page.texels[static_cast<size_t>(row * kImageSide + column)];
}

TEST(ShadedRelief, LeavesFlatGroundExactlyNeutral) {
  for (const double height_m : {0.0, 1234.0, -5000.0}) {
    const Quadcode node = Quadcode::Containing(47, 8, 6);
    const auto page = ShadeRelief(*MakeElevation(node, [&](GridPoint) { return height_m; }), node, nullptr);
    EXPECT_EQ(page->format, ImageFormat::kR8);
    ASSERT_EQ(page->texels.size(), ImagePage::MipOffset(kImageMipLevels, ImageFormat::kR8));
    for (const uint8_t texel : page->texels) ASSERT_EQ(texel, 128);
  }
}

TEST(ShadedRelief, LightComesFromTheNorthWest) {
  const Quadcode node = Quadcode::Containing(47, 8, 10);
  const GeoBox box = node.Box();
  const auto shade = [&](double east, double north) {
    const auto heights = MakeElevation(node, [&](GridPoint p) {
      return 1e5 * (east * (p.longitude_deg() - box.west_deg) + north * (p.latitude_deg() - box.south_deg));
    });
    return Texel(*ShadeRelief(*heights, node, nullptr), 128, 128);
  };
  EXPECT_GT(shade(0.2, -0.2), 140);  // falls to the north-west
  EXPECT_LT(shade(-0.2, 0.2), 116);  // falls to the south-east
  EXPECT_NEAR(shade(0.1, 0.1), 128, 3);
}

TEST(ShadedRelief, NeighboursAgreeWhereTheyOverlap) {
  for (const int level : {3, 9}) {
    const Quadcode west = Quadcode::Containing(44, 9.99, level);
    const Quadcode east = Quadcode::FromColumnRow(level, west.column() + 1, west.row());
    const Quadcode north = Quadcode::FromColumnRow(level, west.column(), west.row() + 1);
    const auto west_page = ShadeRelief(*MakeElevation(west, WavyHeight), west, nullptr);
    const auto east_page = ShadeRelief(*MakeElevation(east, WavyHeight), east, nullptr);
    const auto north_page = ShadeRelief(*MakeElevation(north, WavyHeight), north, nullptr);
    int varied = 0;
    for (int along = 1; along < kOuter; ++along) {
      // All but the outermost texels of each gutter; kImageInner texels on is the same ground.
      for (int across = 1; across < 2 * kImageGutter - 1; ++across) {
        EXPECT_NEAR(Texel(*west_page, kImageInner + across, along), Texel(*east_page, across, along), 1);
        EXPECT_NEAR(Texel(*west_page, along, kImageInner + across), Texel(*north_page, along, across), 1);
      }
      varied += Texel(*west_page, kImageInner, along) != 128 ? 1 : 0;
    }
    EXPECT_GT(varied, 100);
  }
}

TEST(ShadedRelief, TheSeaFloorIsFaint) {
  const Quadcode node = Quadcode::Containing(30, -40, 8);
  const auto contrast = [&](double base_m) {
    const auto heights = MakeElevation(node, [&](GridPoint p) { return base_m + WavyHeight(p) - 1500; });
    const auto page = ShadeRelief(*heights, node, nullptr);
    int greatest = 0;
    for (size_t i = 0; i < 256 * 256; ++i) greatest = std::max(greatest, std::abs(page->texels[i] - 128));
    return greatest;
  };
  EXPECT_GT(contrast(5000), 2 * contrast(-5000));
  EXPECT_GT(contrast(-5000), 0);
}

TEST(ShadedRelief, IsCalmAtThePoles) {
  const Quadcode node = Quadcode::FromColumnRow(5, 3, (kTreeRows << 5) - 1);
  const auto page =
      ShadeRelief(*MakeElevation(node, [](GridPoint p) { return 2800 - 20 * (90 - p.latitude_deg()); }), node, nullptr);
  for (int column = 0; column <= kOuter; ++column) EXPECT_NEAR(Texel(*page, column, kOuter - 4), 128, 3);
}

}  // namespace
}  // namespace belvedere

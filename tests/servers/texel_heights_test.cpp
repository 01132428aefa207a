#include "servers/texel_heights.h"

#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

const TexelHeight& At(const std::vector<TexelHeight>& texels, int column, int row) {
  return texels[static_cast<size_t>(row * kImageSide + column)];
}

TEST(TexelHeights, APlaneIsExactToTheOutermostTexel) {
  const Quadcode node = Quadcode::Containing(47, 8, 10);
  const double spacing_deg = node.HeightDegrees() / kCells;
  const auto page = MakeElevation(node, [&](GridPoint p) {
    return 3 * (p.longitude_deg() - node.Box().west_deg) / spacing_deg +
           5 * (p.latitude_deg() - node.Box().south_deg) / spacing_deg;
  });
  const auto texels = HeightsAtTexels(*page, node, nullptr);
  for (const int column : {0, 1, 77, 254, 255}) {
    for (const int row : {0, 1, 130, 255}) {
      const double east = (column - kImageGutter + 0.5) * kPostsPerTexel;
      const double north = (row - kImageGutter + 0.5) * kPostsPerTexel;
      EXPECT_NEAR(At(texels, column, row).height_m, 3 * east + 5 * north, 0.01);
      EXPECT_NEAR(At(texels, column, row).rise_east_m, 3, 0.01);
      EXPECT_NEAR(At(texels, column, row).rise_north_m, 5, 0.01);
    }
  }
  EXPECT_NEAR(At(texels, 100, 60).mean_m, At(texels, 100, 60).height_m, 0.01);
}

TEST(TexelHeights, AreAboveMeanSeaLevel) {
  const auto sea = Geoid::LoadEgm96();
  ASSERT_TRUE(sea.ok()) << sea.message();
  const Quadcode node = Quadcode::Containing(6, 79, 9);  // the deepest dent of the geoid
  const auto page = MakeElevation(node, [&](GridPoint) { return 10.0; });
  const auto texels = HeightsAtTexels(*page, node, sea->get());
  EXPECT_NEAR(At(texels, 128, 128).height_m,
              10 - (*sea)->Height(node.Box().south_deg + node.HeightDegrees() / 2,
                                  node.Box().west_deg + node.HeightDegrees() / 2),
              0.1);
  EXPECT_GT(At(texels, 128, 128).height_m, 90);
}

}  // namespace
}  // namespace belvedere

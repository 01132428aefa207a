#include "servers/contours.h"

#include "tests/servers/image_test_pages.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

const Quadcode kNode = Quadcode::Containing(47, 8, 10);

// Ground that rises to the north: base_m at the page's southern edge, a line every `texels`.
std::unique_ptr<ElevationPage> Ramp(double base_m, double texels) {
  const double rise_m = ContourInterval(kNode.level()) / texels * kImageInner / kNode.HeightDegrees();
  return MakeElevation(kNode,
                       [=](GridPoint p) { return base_m + rise_m * (p.latitude_deg() - kNode.Box().south_deg); });
}

// Sum of cover over the rows around one, which is the line's width.
double WidthAt(const ImagePage& page, int row) {
  double sum = 0;
  for (int i = row - 4; i <= row + 4; ++i) sum += AlphaAt(page, 128, i) / 255.0;
  return sum;
}

TEST(Contours, IntervalsAreOneTwoOrFive) {
  for (int level = 0; level <= kMaxLevel; ++level) {
    const double interval_m = ContourInterval(level);
    const double lead = interval_m / std::pow(10, std::floor(std::log10(interval_m) + 1e-9));
    EXPECT_TRUE(std::abs(lead - 1) < 1e-6 || std::abs(lead - 2) < 1e-6 || std::abs(lead - 5) < 1e-6) << level;
    EXPECT_LE(interval_m, ContourInterval(std::max(level - 1, 0)));
  }
}

TEST(Contours, LieWhereTheGroundHasTheirHeight) {
  const double interval_m = ContourInterval(kNode.level());
  const auto page = DrawContours(*Ramp(interval_m * 20.5, 20), kNode, nullptr, NoText());
  for (int line = 0; line < 12; ++line) {
    const int row = kImageGutter + 10 + 20 * line;  // lines lie between two rows of texels
    EXPECT_NEAR(AlphaAt(*page, 128, row), AlphaAt(*page, 128, row - 1), 6);
    EXPECT_GT(AlphaAt(*page, 128, row), 60);
    EXPECT_EQ(AlphaAt(*page, 128, row + 10), 0);
  }
}

TEST(Contours, EveryFifthIsHeavierAndWidthsDoNotDependOnTheSlope) {
  const double interval_m = ContourInterval(kNode.level());
  for (const double texels : {12.0, 25.0, 60.0}) {
    const auto page = DrawContours(*Ramp(interval_m * 18, texels), kNode, nullptr, NoText());
    const auto row = [&](int line) { return kImageGutter + static_cast<int>(line * texels); };
    EXPECT_NEAR(WidthAt(*page, row(1)), 0.56, 0.1);  // 19 intervals
    EXPECT_NEAR(WidthAt(*page, row(2)), 1.6, 0.2);   // 20
    EXPECT_NEAR(WidthAt(*page, row(3)), 0.56, 0.1);
  }
}

TEST(Contours, AreBlueUnderTheSeaAndBrownOnLandWithTheCoastBetween) {
  const double interval_m = ContourInterval(kNode.level());
  const auto page = DrawContours(*Ramp(-3 * interval_m, 40), kNode, nullptr, NoText());
  const auto line = [&](int number) { return RgbaAt(*page, 128, kImageGutter + 40 * number); };
  EXPECT_GT(line(1)[2], line(1)[0] + 80);  // blue
  EXPECT_GT(line(5)[0], line(5)[2] + 80);  // brown
  EXPECT_GT(line(3)[2], line(3)[0] + 60);
  EXPECT_LT(line(3)[2], line(1)[2] - 40);  // darker
  EXPECT_GT(WidthAt(*page, kImageGutter + 120), 2.0);
}

TEST(Contours, FlatGroundHasNoneAndCrowdedOnesFade) {
  const double interval_m = ContourInterval(kNode.level());
  const auto most = [](const ImagePage& page) {
    int alpha = 0;
    for (int i = 0; i < kImageSide; ++i) alpha = std::max(alpha, AlphaAt(page, 128, i));
    return alpha;
  };
  EXPECT_EQ(most(*DrawContours(*Ramp(20 * interval_m, 1e9), kNode, nullptr, NoText())), 0);
  EXPECT_EQ(most(*DrawContours(*Ramp(20 * interval_m, 0.4), kNode, nullptr, NoText())), 0);
  EXPECT_GT(most(*DrawContours(*Ramp(20 * interval_m, 2), kNode, nullptr, NoText())), 200);  // the heavy ones are left
}

TEST(Contours, LevelGroundAtALinesHeightHasNeitherLineNorText) {
  const double height_m = 20 * ContourInterval(kNode.level());
  const PageText text;
  ASSERT_TRUE(text.font().ok()) << text.font().message();
  const auto page = DrawContours(*MakeElevation(kNode, [=](GridPoint) { return height_m; }), kNode, nullptr, text);
  for (int row = 0; row < kImageSide; ++row) {
    for (int column = 0; column < kImageSide; ++column) ASSERT_EQ(AlphaAt(*page, column, row), 0);
  }
}

TEST(Contours, GoOnOverBorders) {
  for (const int level : {4, 9}) {
    const Quadcode node = Quadcode::Containing(44, 9.99, level);
    const Quadcode east = Quadcode::FromColumnRow(level, node.column() + 1, node.row());
    const Quadcode north = Quadcode::FromColumnRow(level, node.column(), node.row() + 1);
    const auto draw = [&](Quadcode at) { return DrawContours(*MakeElevation(at, WavyHeight), at, nullptr, NoText()); };
    const auto page = draw(node);
    ExpectNoSeam(*page, *draw(east), false, 3);
    ExpectNoSeam(*page, *draw(north), true, 3);
  }
}

TEST(Contours, HeightsAreWrittenWithinThePage) {
  const PageText text;
  ASSERT_TRUE(text.font().ok()) << text.font().message();
  const auto heights = Ramp(20 * ContourInterval(kNode.level()), 15);
  const auto lines = DrawContours(*heights, kNode, nullptr, NoText());
  const auto page = DrawContours(*heights, kNode, nullptr, text);
  int written = 0;
  for (int row = 0; row < kImageSide; ++row) {
    for (int column = 0; column < kImageSide; ++column) {
      if (RgbaAt(*page, column, row) == RgbaAt(*lines, column, row)) continue;
      ++written;
      EXPECT_TRUE(column >= kInnerTexels.west && column < kInnerTexels.east && row >= kInnerTexels.south &&
                  row < kInnerTexels.north);
    }
  }
  EXPECT_GT(written, 500);
  EXPECT_LT(written, 4000);
  EXPECT_EQ(page->texels, DrawContours(*heights, kNode, nullptr, text)->texels);
}

}  // namespace
}  // namespace belvedere

#include "servers/graticule.h"

#include "tests/servers/image_test_pages.h"

#include <gtest/gtest.h>

#include <cmath>

namespace belvedere {
namespace {

TEST(Graticule, StepsAreWholeAndAtLeastAQuarterOfTheSide) {
  EXPECT_EQ(GridStep(0), 15 * kGridUnitsPerDegree);
  EXPECT_EQ(GridStep(1), 10 * kGridUnitsPerDegree);
  EXPECT_EQ(GridStep(4), kGridUnitsPerDegree);
  EXPECT_EQ(GridStep(5), kGridUnitsPerDegree / 2);
  EXPECT_EQ(GridStep(6), kGridUnitsPerDegree / 3);
  EXPECT_EQ(GridStep(kMaxLevel), 1);
  for (int level = 0; level <= kMaxLevel; ++level) {
    const double share = static_cast<double>(GridStep(level)) / (45.0 / (1 << level) * kGridUnitsPerDegree);
    EXPECT_GE(share, 0.25);
    EXPECT_LT(share, 0.7);
  }
}

TEST(Graticule, NamesAreAsFineAsTheStep) {
  constexpr int64_t kDegree = kGridUnitsPerDegree;
  EXPECT_EQ(CoordinateName(45 * kDegree, 15 * kDegree, true), "45\xB0N");
  EXPECT_EQ(CoordinateName(-kDegree * 13 / 2, kDegree / 2, true),
            "6\xB0"
            "30'S");
  EXPECT_EQ(CoordinateName(-118 * kDegree - 20 * 100, 2000, false),
            "118\xB0"
            "00'20\"W");
  EXPECT_EQ(CoordinateName(7 * kDegree + 5, 5, false),
            "7\xB0"
            "00'00.05\"E");
  EXPECT_EQ(CoordinateName(0, kDegree, true), "0\xB0");
  EXPECT_EQ(CoordinateName(185 * kDegree, 5 * kDegree, false), "175\xB0W");
  EXPECT_EQ(CoordinateName(180 * kDegree, 5 * kDegree, false), "180\xB0");
}

// The middle of a line, from its cover of the texels around.
double MiddleOf(const ImagePage& page, int row, int from, int to) {
  double sum = 0, moment = 0;
  for (int column = from; column < to; ++column) {
    sum += AlphaAt(page, column, row);
    moment += AlphaAt(page, column, row) * (column + 0.5);
  }
  return moment / sum;
}

TEST(Graticule, LinesLieWhereTheCoordinatesAre) {
  for (const int level : {2, 6, 15}) {
    const Quadcode node = Quadcode::Containing(46.2, 8.1, level);
    const double step_deg = static_cast<double>(GridStep(level)) / kGridUnitsPerDegree;
    const auto page = DrawGraticule(node, NoText());
    const double line_deg = step_deg * std::ceil(node.Box().west_deg / step_deg + 0.1);
    const double texel = kImageGutter + (line_deg - node.Box().west_deg) / node.HeightDegrees() * kImageInner;
    const double line_row =
        kImageGutter + (step_deg * std::ceil(node.Box().south_deg / step_deg) - node.Box().south_deg) /
                           node.HeightDegrees() * kImageInner;
    const int row = static_cast<int>(line_row) + 20;  // clear of the lines of latitude
    EXPECT_NEAR(MiddleOf(*page, row, static_cast<int>(texel) - 4, static_cast<int>(texel) + 5), texel, 0.05) << level;
  }
}

TEST(Graticule, GoesOnOverBordersWhateverTheText) {
  const PageText text;
  for (const int level : {0, 7, 12}) {
    const Quadcode node = Quadcode::Containing(30, -0.01, level);
    const Quadcode east = Quadcode::FromColumnRow(level, node.column() + 1, node.row());
    ExpectNoSeam(*DrawGraticule(node, text), *DrawGraticule(east, text), false, 1);
  }
}

TEST(Graticule, ThePoleHasNoLine) {
  const Quadcode node = Quadcode::FromColumnRow(3, 5, (kTreeRows << 3) - 1);
  const auto page = DrawGraticule(node, NoText());
  int covered = 0;
  for (int column = 0; column < kImageSide; ++column) {
    covered += AlphaAt(*page, column, kImageGutter + kImageInner - 1) > 0 ? 1 : 0;
  }
  EXPECT_LT(covered, 50);  // meridians alone
}

TEST(Graticule, OneLineOfEachDirectionIsNamed) {
  const PageText text;
  ASSERT_TRUE(text.font().ok()) << text.font().message();
  const Quadcode node = Quadcode::Containing(46.2, 8.1, 6);
  const auto lines = DrawGraticule(node, NoText());
  const auto page = DrawGraticule(node, text);
  int written = 0;
  for (size_t i = 3; i < size_t{4} * kImageSide * kImageSide; i += 4) {
    written += page->texels[i] != lines->texels[i] ? 1 : 0;
  }
  EXPECT_GT(written, 400);
  EXPECT_LT(written, 3000);
}

}  // namespace
}  // namespace belvedere

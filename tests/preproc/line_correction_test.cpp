// Ground along roads and rivers: level across, smooth or falling along, and the same from every page.
#include "preproc/vectors/line_correction.h"

#include "runtime/paging/page.h"

#include <gtest/gtest.h>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace belvedere {
namespace {

constexpr double kMetresPerUnit = 6378137 * 3.14159265358979 / 180 * 45 / (1 << 29);
// Posts 4.8 m apart, at the equator, so that metres are the same both ways.
const Quadcode kNode = Quadcode::Containing(0.01, 10.01, 13);

GridPlace Offset(double east_m, double north_m) {
  const GridPoint corner = kNode.SouthWest();
  return {corner.x + std::llround(east_m / kMetresPerUnit), corner.y + std::llround(north_m / kMetresPerUnit)};
}
double SpacingM() {
  return kNode.PostSpacingNorth() * kMetresPerUnit;
}

Feature Line(FeatureClass of, const FeaturePart& places) {
  Feature feature;
  feature.of = of;
  feature.shape = FeatureShape::kLines;
  feature.parts = {places};
  return feature;
}

// Metres east and north of the node's corner.
glm::dvec2 MetresOf(double latitude_deg, double longitude_deg) {
  const GridPoint corner = kNode.SouthWest();
  const double per_degree = kMetresPerUnit * (1 << 29) / 45;
  return {(longitude_deg - corner.longitude_deg()) * per_degree, (latitude_deg - corner.latitude_deg()) * per_degree};
}

std::vector<int32_t> Posts(Quadcode node, const std::function<double(double, double)>& height_m) {
  std::vector<int32_t> heights;
  const double step = node.HeightDegrees() / kCells;
  const GridPoint corner = node.SouthWest();
  for (int row = -kApron; row < kPosts + kApron; ++row) {
    for (int column = -kApron; column < kPosts + kApron; ++column)
      heights.push_back(static_cast<int32_t>(
          std::lrint(1000 * height_m(corner.latitude_deg() + row * step, corner.longitude_deg() + column * step))));
  }
  return heights;
}
double At(const std::vector<int32_t>& heights, int column, int row) {
  return heights[static_cast<size_t>((row + kApron) * kElevationSide + column + kApron)] / 1000.0;
}

// A slope to the north with a wave across: level on the road, untouched away from it.
TEST(LineCorrection, ARoadIsLevelAcross) {
  const auto ground = [](double latitude_deg, double longitude_deg) {
    const glm::dvec2 at = MetresOf(latitude_deg, longitude_deg);
    return 100 + 0.3 * at.y + 0.002 * at.x;
  };
  LineCorrection correction;
  const Feature road = Line(FeatureClass::kRoad, {Offset(-200, 300), Offset(900, 300)});
  correction.Add(std::span(&road, 1), 30, ground);
  std::vector<int32_t> heights = Posts(kNode, ground);
  const std::vector<int32_t> before = heights;
  correction.Apply(kNode, heights);
  int on_road = 0, away = 0;
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      const double off_m = std::abs(row * SpacingM() - 300);
      if (off_m < 14.5) {
        ++on_road;
        ASSERT_NEAR(At(heights, column, row), 100 + 0.3 * 300 + 0.002 * column * SpacingM(), 0.02);
      } else if (off_m > 30.5) {
        ++away;
        ASSERT_EQ(At(heights, column, row), At(before, column, row));
      } else {
        const double level = 190 + 0.002 * column * SpacingM(), was = At(before, column, row);
        ASSERT_GE(At(heights, column, row), std::min(level, was) - 0.02);
        ASSERT_LE(At(heights, column, row), std::max(level, was) + 0.02);
      }
    }
  }
  EXPECT_GT(on_road, 500);
  EXPECT_GT(away, 5000);
}

TEST(LineCorrection, ARoadHasNoSteps) {
  const auto steps = [](double latitude_deg, double longitude_deg) {
    return 10 * std::floor(MetresOf(latitude_deg, longitude_deg).x / 90);  // as from pixels of 90 m
  };
  LineCorrection correction;
  const Feature road = Line(FeatureClass::kRoad, {Offset(0, 300), Offset(600, 300)});
  correction.Add(std::span(&road, 1), 20, steps);
  std::vector<int32_t> heights = Posts(kNode, steps);
  correction.Apply(kNode, heights);
  const int row = static_cast<int>(std::lrint(300 / SpacingM()));
  double steepest = 0;
  for (int column = 0; column + 1 < kPosts && (column + 1) * SpacingM() < 600; ++column)
    steepest = std::max(steepest, std::abs(At(heights, column + 1, row) - At(heights, column, row)));
  EXPECT_LT(steepest, 2) << "of 10 m a pixel";
}

TEST(LineCorrection, ARiverNeverRises) {
  const auto rough = [](double latitude_deg, double longitude_deg) {
    const glm::dvec2 at = MetresOf(latitude_deg, longitude_deg);
    return 50 - 0.05 * at.x + 3 * std::sin(at.x / 17);
  };
  for (const bool is_backwards : {false, true}) {
    LineCorrection correction;
    FeaturePart places{Offset(10, 200), Offset(590, 200)};
    if (is_backwards) std::reverse(places.begin(), places.end());
    const Feature river = Line(FeatureClass::kRiver, places);
    correction.Add(std::span(&river, 1), 25, rough);
    std::vector<int32_t> heights = Posts(kNode, rough);
    correction.Apply(kNode, heights);
    const int row = static_cast<int>(std::lrint(200 / SpacingM()));
    for (int column = 4; (column + 1) * SpacingM() < 585; ++column)
      ASSERT_LE(At(heights, column + 1, row), At(heights, column, row) + 0.0011) << column;
  }
}

TEST(LineCorrection, NeighboursAgree) {
  const auto ground = [](double latitude_deg, double longitude_deg) {
    return 1e4 * std::sin(40 * latitude_deg) * std::cos(30 * longitude_deg);
  };
  LineCorrection correction;
  const Feature roads[] = {Line(FeatureClass::kRoad, {Offset(-300, -200), Offset(900, 700), Offset(1200, 100)}),
                           Line(FeatureClass::kRoad, {Offset(610, -300), Offset(612, 900)})};
  correction.Add(roads, 40, ground);
  const Quadcode east = Quadcode::FromColumnRow(13, kNode.column() + 1, kNode.row());
  std::vector<int32_t> ours = Posts(kNode, ground), theirs = Posts(east, ground);
  const std::vector<int32_t> before = ours;
  correction.Apply(kNode, ours);
  correction.Apply(east, theirs);
  int changed = 0;
  for (int row = -kApron; row < kPosts + kApron; ++row) {
    for (int column = kCells - kApron; column <= kCells + kApron; ++column) {
      if (At(before, column, row) != At(theirs, column - kCells, row)) ++changed;
      ASSERT_EQ(At(ours, column, row), At(theirs, column - kCells, row)) << column << " " << row;
    }
  }
  EXPECT_GT(changed, 50);
}

TEST(LineCorrection, CoarsePagesAreLeftAlone) {
  const auto ground = [](double, double longitude_deg) { return longitude_deg; };
  LineCorrection correction;
  EXPECT_TRUE(correction.empty());
  const Feature road = Line(FeatureClass::kRoad, {Offset(0, 0), Offset(500, 500)});
  correction.Add(std::span(&road, 1), 30, [](double, double) { return 500.0; });
  EXPECT_FALSE(correction.empty());
  for (int level = 0; level <= 13; ++level) {
    const Quadcode node = kNode.Ancestor(level);
    std::vector<int32_t> heights = Posts(node, ground);
    const std::vector<int32_t> before = heights;
    correction.Apply(node, heights);
    EXPECT_EQ(heights == before, node.PostSpacingNorth() * kMetresPerUnit > 30) << level;
  }
}

TEST(LineCorrection, GoesOver180) {
  LineCorrection correction;
  const Feature road = Line(FeatureClass::kRoad, {GridPlace::At(5, 179.99), GridPlace::At(5, 180.01)});
  correction.Add(std::span(&road, 1), 60, [](double, double longitude_deg) {
    EXPECT_GE(std::abs(longitude_deg), 179.9);
    return 77.0;
  });
  for (const double longitude_deg : {179.9985, -179.9985}) {
    const Quadcode node = Quadcode::Containing(5, longitude_deg, 13);
    std::vector<int32_t> heights = Posts(node, [](double, double) { return 0.0; });
    correction.Apply(node, heights);
    EXPECT_GT(std::count(heights.begin(), heights.end(), 77'000), 100) << longitude_deg;
  }
}

}  // namespace
}  // namespace belvedere

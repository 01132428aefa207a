#include "servers/terrain_builder.h"

#include "runtime/earth/bisection.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/frame.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>
#include <GeographicLib/Geocentric.hpp>
#include <glm/geometric.hpp>

#include <random>
#include <set>

namespace belvedere {
namespace {

glm::dvec3 Exact(GridPoint point, double height_m) {
  glm::dvec3 ecef;
  GeographicLib::Geocentric::WGS84().Forward(point.latitude_deg(), point.longitude_deg(), height_m, ecef.x, ecef.y,
                                             ecef.z);
  return ecef;
}

GridPoint PointOf(Quadcode node, int column, int row) {
  const GridPoint corner = node.SouthWest();
  return {corner.x + static_cast<uint32_t>(column) * node.PostSpacingEast(),
          corner.y + static_cast<uint32_t>(row) * node.PostSpacingNorth()};
}

glm::dvec3 PositionOf(const TerrainVertex& vertex) {
  return {vertex.x, vertex.y, vertex.z};
}

glm::dvec3 NormalOf(const TerrainVertex& vertex) {
  const auto snorm = [](uint32_t bits) { return static_cast<int16_t>(bits & 0xFFFFU) / 32767.0; };
  glm::dvec3 n(snorm(vertex.normal), snorm(vertex.normal >> 16), 0);
  n.z = 1 - std::abs(n.x) - std::abs(n.y);
  if (n.z < 0) {
    const double x = n.x;
    n.x = (1 - std::abs(n.y)) * (x < 0 ? -1 : 1);
    n.y = (1 - std::abs(x)) * (n.y < 0 ? -1 : 1);
  }
  return glm::normalize(n);
}

std::unique_ptr<TerrainPage> Build(Quadcode node, double exaggeration = 1) {
  const auto heights = MakeElevation(node, WavyHeight);
  return BuildTerrain({node, heights.get(), node, false, exaggeration});
}

// Nodes of a level at the places where coordinates are awkward, and some anywhere.
std::vector<Quadcode> NodesToTry(int level) {
  std::mt19937 random(static_cast<unsigned>(level));
  const int64_t columns = int64_t{kTreeColumns} << level;
  const int64_t rows = int64_t{kTreeRows} << level;
  std::vector<Quadcode> nodes;
  for (const int64_t column : {int64_t{0}, columns - 1, columns / 2}) {
    for (const int64_t row : {int64_t{0}, rows - 1, rows / 2, rows / 4})
      nodes.push_back(Quadcode::FromColumnRow(level, column, row));
  }
  for (int i = 0; i < 6; ++i) {
    nodes.push_back(Quadcode::FromColumnRow(level, static_cast<int64_t>(random()) % columns,
                                            static_cast<int64_t>(random()) % rows));
  }
  return nodes;
}

TEST(TerrainBuilder, VerticesAreWithinAMillimetreOfGeographicLib) {
  for (const int level : {8, 9, 12, 17, 22}) {
    for (const Quadcode node : NodesToTry(level)) {
      const auto heights = MakeElevation(node, WavyHeight);
      const auto page = BuildTerrain({node, heights.get(), node, false, 1});
      const Frame frame = FrameOf(node);
      double worst_m = 0;
      for (int row = 0; row < kPosts; ++row) {
        for (int column = 0; column < kPosts; ++column) {
          const TerrainVertex& vertex = page->vertices[static_cast<size_t>(row * kPosts + column)];
          const glm::dvec3 exact = Exact(PointOf(node, column, row), heights->at(column, row) * 1e-3);
          worst_m = std::max(worst_m, glm::distance(frame.ToEcef(PositionOf(vertex)), exact));
        }
      }
      EXPECT_LT(worst_m, 1e-3) << node.ToString();
    }
  }
}

TEST(TerrainBuilder, APoleIsOnePoint) {
  for (const int level : {0, 3, 8, 14}) {
    for (const bool north : {false, true}) {
      const int64_t row = north ? (int64_t{kTreeRows} << level) - 1 : 0;
      const Quadcode node = Quadcode::FromColumnRow(level, 5, row);
      const auto page = Build(node);
      const size_t first = north ? static_cast<size_t>(kCells * kPosts) : 0;
      for (size_t i = 0; i < kPosts; ++i) {
        EXPECT_EQ(page->vertices[first + i].x, page->vertices[first].x);
        EXPECT_EQ(page->vertices[first + i].y, page->vertices[first].y);
        EXPECT_EQ(page->vertices[first + i].z, page->vertices[first].z);
      }
      const Frame frame = FrameOf(node);
      const glm::dvec3 ecef = frame.ToEcef(PositionOf(page->vertices[first]));
      EXPECT_NEAR(ecef.x, 0, level >= 8 ? 1e-3 : 1.0);
      EXPECT_NEAR(ecef.y, 0, level >= 8 ? 1e-3 : 1.0);
    }
  }
}

// Two neighbours at level 9 in one frame hold the same floats along their border; across 180 E the same ECEF points.
TEST(TerrainBuilder, NeighboursShareTheirBorder) {
  const Quadcode west = Quadcode::FromColumnRow(9, 1000, 700);
  const auto west_page = Build(west);
  const auto east_page = Build(Quadcode::FromColumnRow(9, 1001, 700));
  const Quadcode before = Quadcode::FromColumnRow(9, -1, 700);
  const auto before_page = Build(before);
  const Quadcode after = Quadcode::FromColumnRow(9, 0, 700);
  const auto after_page = Build(after);
  for (int row = 0; row < kPosts; ++row) {
    const auto from_west = static_cast<size_t>(row * kPosts);
    const size_t from_east = from_west + kCells;
    EXPECT_EQ(west_page->vertices[from_east].x, east_page->vertices[from_west].x);
    EXPECT_EQ(west_page->vertices[from_east].y, east_page->vertices[from_west].y);
    EXPECT_EQ(west_page->vertices[from_east].z, east_page->vertices[from_west].z);
    EXPECT_EQ(west_page->vertices[from_east].normal, east_page->vertices[from_west].normal);
    const Frame frame_before = FrameOf(before);
    const Frame frame_after = FrameOf(after);
    EXPECT_LT(glm::distance(frame_before.ToEcef(PositionOf(before_page->vertices[from_east])),
                            frame_after.ToEcef(PositionOf(after_page->vertices[from_west]))),
              2e-3);
    EXPECT_LT(glm::distance(frame_before.ecef_from_frame * NormalOf(before_page->vertices[from_east]),
                            frame_after.ecef_from_frame * NormalOf(after_page->vertices[from_west])),
              2e-4);
  }
}

TEST(TerrainBuilder, NormalsAreThoseOfTheSurface) {
  const Quadcode node = Quadcode::Containing(46.5, 8.2, 11);
  const auto page = Build(node);
  for (int row = 2; row < kCells - 2; row += 9) {
    for (int column = 2; column < kCells - 2; column += 7) {
      const auto at = [&](int c, int r) { return PositionOf(page->vertices[static_cast<size_t>(r * kPosts + c)]); };
      const glm::dvec3 normal = glm::normalize(
          glm::cross(at(column + 1, row) - at(column - 1, row), at(column, row + 1) - at(column, row - 1)));
      EXPECT_LT(glm::distance(normal, NormalOf(page->vertices[static_cast<size_t>(row * kPosts + column)])), 2e-3);
    }
  }
}

// The delta values as terrain_builder.h words them, found by walking down the triangles with no regard to speed.
class BruteForce {
 public:
  explicit BruteForce(const TerrainPage& page)
      : page_(page), deltas_(kVerticesPerPage, 0.0), levels_(kVerticesPerPage, kNoLevel) {
    Split({kCells, 0}, {0, 0}, {kCells, kCells}, 0);
    Split({0, kCells}, {kCells, kCells}, {0, 0}, 0);
  }
  double delta(size_t post) const { return deltas_[post]; }
  int level(size_t post) const { return levels_[post]; }

 private:
  glm::dvec3 At(Post post) const { return PositionOf(page_.vertices[static_cast<size_t>(post.index())]); }

  void Split(Post a, Post b, Post c, int level) {
    if (level == kBisectionLevels) return;
    const Post middle{(b.column + c.column) / 2, (b.row + c.row) / 2};
    const auto index = static_cast<size_t>(middle.index());
    levels_[index] = level;
    deltas_[index] = std::max(deltas_[index], ErrorWithin(a, b, c));
    Split(middle, a, b, level + 1);
    Split(middle, c, a, level + 1);
  }

  double ErrorWithin(Post a, Post b, Post c) const {
    double greatest = 0;
    const double area = (b.column - a.column) * (c.row - a.row) - (c.column - a.column) * (b.row - a.row);
    for (int row = std::min({a.row, b.row, c.row}); row <= std::max({a.row, b.row, c.row}); ++row) {
      for (int column = std::min({a.column, b.column, c.column}); column <= std::max({a.column, b.column, c.column});
           ++column) {
        const double u = ((column - a.column) * (c.row - a.row) - (c.column - a.column) * (row - a.row)) / area;
        const double v = ((b.column - a.column) * (row - a.row) - (column - a.column) * (b.row - a.row)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        greatest = std::max(greatest, glm::distance(At({column, row}), (1 - u - v) * At(a) + u * At(b) + v * At(c)));
      }
    }
    return greatest;
  }

  const TerrainPage& page_;
  std::vector<double> deltas_;
  std::vector<int> levels_;
};

TEST(TerrainBuilder, DeltaValuesAreTheErrorsOfTheTrianglesThatAPostSplits) {
  for (const Quadcode node :
       {Quadcode::Root(20), Quadcode::Containing(37, -118, 9), Quadcode::FromColumnRow(10, 17, 0)}) {
    const auto page = Build(node);
    const BruteForce expected(*page);
    const double tolerance_m = node.level() == 0 ? 2.0 : 2e-3;
    for (size_t post = 0; post < kVerticesPerPage; ++post) {
      const Post at{static_cast<int>(post) % kPosts, static_cast<int>(post) / kPosts};
      ASSERT_EQ(LevelOf(at), expected.level(post)) << at.column << " " << at.row;
      if (LevelOf(at) == kNoLevel) continue;
      ASSERT_NEAR(page->deltas[post], expected.delta(post), tolerance_m) << at.column << " " << at.row;
    }
  }
}

TEST(TerrainBuilder, SpreadsHoldTheTrianglesThatAPostSplits) {
  const auto page = Build(Quadcode::Containing(37, -118, 9));
  std::array<double, kBisections> greatest{};
  for (int index = 0; index < kVerticesPerPage; ++index) {
    const Post post{index % kPosts, index / kPosts};
    if (LevelOf(post) == kNoLevel) continue;
    const Split split = SplitAt(post);
    for (const Post corner : {split.end_a, split.end_b, split.apex_a, split.apex_b}) {
      if (!corner.inside()) continue;
      double& here = greatest[static_cast<size_t>(LevelOf(post))];
      here = std::max(here, glm::distance(PositionOf(page->vertices[static_cast<size_t>(index)]),
                                          PositionOf(page->vertices[static_cast<size_t>(corner.index())])));
    }
  }
  for (size_t level = 0; level < greatest.size(); ++level) {
    EXPECT_GE(page->spread_m[level], greatest[level] * (1 - 1e-6));
    EXPECT_LE(page->spread_m[level], greatest[level] * (1 + 1e-5));
  }
}

TEST(TerrainBuilder, WhatAPageLeavesOutRaisesEveryDeltaValue) {
  const Quadcode node = Quadcode::Containing(37, -118, 9);
  auto heights = MakeElevation(node, WavyHeight);
  heights->error_m = 12;
  heights->block_errors_m.fill(12);
  const auto coarse = BuildTerrain({node, heights.get(), node, true, 1});
  const auto finest = BuildTerrain({node, heights.get(), node, false, 1});
  EXPECT_EQ(finest->error_m, 0);
  EXPECT_GT(coarse->error_m, 12);
  EXPECT_LT(coarse->error_m, 12.1);
  for (size_t post = 0; post < kVerticesPerPage; ++post) {
    ASSERT_NEAR(coarse->deltas[post] - coarse->error_m, finest->deltas[post], 1e-2);
  }
}

TEST(TerrainBuilder, WhatABlockLeavesOutRaisesTheDeltaValuesThereAlone) {
  const Quadcode node = Quadcode::Containing(37, -118, 9);
  auto heights = MakeElevation(node, WavyHeight);
  const auto smooth = BuildTerrain({node, heights.get(), node, true, 1});
  heights->error_m = heights->block_errors_m[3 * kErrorBlocks + 5] = 500;  // cells 40..47 east, 24..31 north
  const auto cliff = BuildTerrain({node, heights.get(), node, true, 1});
  EXPECT_GT(cliff->error_m, 500);
  const auto delta = [](const TerrainPage& page, int column, int row) {
    return page.deltas[static_cast<size_t>(row * kPosts + column)];
  };
  EXPECT_GE(delta(*cliff, 45, 27), 500);
  EXPECT_GE(delta(*cliff, 40, 31), 500) << "a post on the line between blocks belongs to both";
  EXPECT_GE(delta(*cliff, kCells / 2, kCells / 2), 500) << "the page's middle splits all of it";
  EXPECT_EQ(delta(*cliff, 101, 99), delta(*smooth, 101, 99));
  EXPECT_EQ(delta(*cliff, 53, 27), delta(*smooth, 53, 27));
}

// The builder's delta values hold for the page's own posts, where they are.
TEST(TerrainBuilder, TheDatasetsDeltaValuesAreTakenWhereTheyHold) {
  const Quadcode node = Quadcode::Containing(37, -118, 9);
  const auto heights = MakeElevation(node, WavyHeight);
  const auto without = BuildTerrain({node, heights.get(), node, true, 1});
  heights->deltas.greatest_m = 64;
  heights->deltas.steps.assign(kVerticesPerPage, kDeltaStepsPerOctave);
  const auto with = BuildTerrain({node, heights.get(), node, true, 1});
  for (size_t post = 0; post < kVerticesPerPage; ++post) ASSERT_NEAR(with->deltas[post], 32, 1e-3);
  EXPECT_EQ(with->spread_m, without->spread_m);

  const auto exaggerated = BuildTerrain({node, heights.get(), node, true, 2});
  EXPECT_GT(exaggerated->deltas[kVerticesPerPage / 2], 1.9 * without->deltas[kVerticesPerPage / 2]);
  const auto below = BuildTerrain({node.Child(0), heights.get(), node, false, 1});
  EXPECT_LT(below->deltas[kPosts + 1], 1);
  TerrainInput laid{node, heights.get(), node, true, 1};
  laid.laid_ecef[0] = BorderPosts(laid, Side::kWest);
  EXPECT_EQ(BuildTerrain(laid)->deltas, without->deltas);
}

TEST(TerrainBuilder, TheSphereHoldsTheNodeAndAllUnderIt) {
  for (const Quadcode node :
       {Quadcode::Root(3), Quadcode::Root(31), Quadcode::Containing(-89.9, 10, 4), Quadcode::Containing(46, 8, 10)}) {
    auto heights = MakeElevation(node, WavyHeight);
    heights->min_m = -400;
    heights->max_m = 9000;
    const auto page = BuildTerrain({node, heights.get(), node, true, 1});
    std::mt19937 random(3);
    const GeoBox box = node.Box();
    std::uniform_real_distribution<double> latitude(box.south_deg, box.north_deg);
    std::uniform_real_distribution<double> longitude(box.west_deg, box.east_deg);
    for (int i = 0; i < 4000; ++i) {
      const glm::dvec3 point = ToEcef({latitude(random), longitude(random), i % 2 == 0 ? -400.0 : 9000.0});
      ASSERT_LE(glm::distance(point, page->center_ecef), page->radius_m) << node.ToString();
    }
    // ... and is not much larger than it must be.
    const double half_m =
        0.5 * glm::distance(ToEcef({box.south_deg, box.west_deg, 0}), ToEcef({box.north_deg, box.east_deg, 0}));
    EXPECT_LT(page->radius_m, 1.5 * half_m + 9400);
  }
}

TEST(TerrainBuilder, ExaggerationMultipliesHeights) {
  const Quadcode node = Quadcode::Containing(37, -118, 9);
  const auto heights = MakeElevation(node, WavyHeight);
  const auto page = BuildTerrain({node, heights.get(), node, false, 3});
  const Frame frame = FrameOf(node);
  const glm::dvec3 exact = Exact(PointOf(node, 40, 50), 3e-3 * heights->at(40, 50));
  EXPECT_LT(glm::distance(frame.ToEcef(PositionOf(page->vertices[50 * kPosts + 40])), exact), 1e-3);
  EXPECT_FLOAT_EQ(page->max_height_m, 3 * heights->max_m);
}

TEST(TerrainBuilder, BelowTheDataHeightsAreBilinearAndNormalsSmooth) {
  const Quadcode ancestor = Quadcode::Containing(37, -118, 8);
  const auto heights = MakeElevation(ancestor, WavyHeight);
  const Quadcode node = ancestor.Child(1).Child(2);
  const auto page = BuildTerrain({node, heights.get(), ancestor, false, 1});
  EXPECT_EQ(page->error_m, 0);
  const Frame frame = FrameOf(node);
  // Child 1 of the ancestor starts at its column 64, and child 2 of that at row 32; four posts of ours to one of its.
  for (const auto& [column, row] : {std::pair{0, 0}, {4, 8}, {6, 8}, {7, 9}, {128, 128}}) {
    const double x = 64 + column / 4.0;
    const double y = 32 + row / 4.0;
    const int west = static_cast<int>(x);
    const int south = static_cast<int>(y);
    const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
    const double height_m =
        1e-3 * mix(mix(heights->at(west, south), heights->at(west + 1, south), x - west),
                   mix(heights->at(west, south + 1), heights->at(west + 1, south + 1), x - west), y - south);
    const TerrainVertex& vertex = page->vertices[static_cast<size_t>(row * kPosts + column)];
    EXPECT_LT(glm::distance(frame.ToEcef(PositionOf(vertex)), Exact(PointOf(node, column, row), height_m)), 1e-3);
  }
  // At a post of the ancestor the normal is the ancestor's own.
  const auto coarse = BuildTerrain({ancestor, heights.get(), ancestor, false, 1});
  EXPECT_LT(glm::distance(NormalOf(coarse->vertices[34 * kPosts + 65]), NormalOf(page->vertices[8 * kPosts + 4])),
            1e-4);
}

TEST(TerrainBuilder, WithNoHeightsTheEllipsoidIsDrawn) {
  const Quadcode node = Quadcode::Root(12);
  const auto page = BuildTerrain({node, nullptr, node, true, 1});
  const Frame frame = FrameOf(node);
  for (size_t post = 0; post < kVerticesPerPage; post += 97) {
    EXPECT_NEAR(ToGeodetic(frame.ToEcef(PositionOf(page->vertices[post]))).height_m, 0, 0.5);
  }
  EXPECT_NEAR(page->error_m, 60.2, 0.5);  // 39 km from post to post
  EXPECT_EQ(page->min_height_m, 0);
}

}  // namespace
}  // namespace belvedere

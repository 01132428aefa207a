#include "runtime/paging/terrain_height.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/frame.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

constexpr DataType kTerrain = 0;

// A page whose ground rises to the north, by so many metres a cell.
std::unique_ptr<TerrainPage> Slope(Quadcode node, double base_m, double rise_m_per_cell) {
  auto page = std::make_unique<TerrainPage>();
  page->node = node;
  page->vertices.resize(kVerticesPerPage);
  const Frame frame = FrameOf(node);
  const GeoBox box = node.Box();
  const double step = node.HeightDegrees() / kCells;
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      const glm::vec3 local(frame.ToFrame(
          ToEcef({box.south_deg + row * step, box.west_deg + column * step, base_m + row * rise_m_per_cell})));
      page->vertices[static_cast<size_t>(row * kPosts + column)] = {local.x, local.y, local.z, 0};
    }
  }
  return page;
}

TEST(TerrainHeight, IsBilinearBetweenPosts) {
  const Quadcode node = Quadcode::Containing(37, -118, 10);
  const auto page = Slope(node, 1000, 2);
  const GeoBox box = node.Box();
  const double step = node.HeightDegrees() / kCells;
  EXPECT_NEAR(GroundOnPage(*page, box.south_deg, box.west_deg).height_m, 1000, 0.01);
  EXPECT_NEAR(GroundOnPage(*page, box.south_deg + 10.5 * step, box.west_deg + 3.25 * step).height_m, 1021, 0.01);
  EXPECT_NEAR(GroundOnPage(*page, box.north_deg, box.east_deg).height_m, 1256, 0.01);
}

TEST(TerrainHeight, TheNormalLeansAwayFromTheRise) {
  const Quadcode node = Quadcode::Containing(37, -118, 10);
  const auto page = Slope(node, 1000, 10);
  const GeoBox box = node.Box();
  const GroundPoint ground =
      GroundOnPage(*page, 0.5 * (box.south_deg + box.north_deg), 0.5 * (box.west_deg + box.east_deg));
  const LevelAxes axes = LevelAxesAt(0.5 * (box.south_deg + box.north_deg), 0.5 * (box.west_deg + box.east_deg));
  const double cell_m = node.HeightDegrees() / kCells * 110'980;  // of latitude, at 37 degrees
  EXPECT_NEAR(-glm::dot(ground.normal_ecef, axes.north) / glm::dot(ground.normal_ecef, axes.up), 10 / cell_m, 1e-3);
  EXPECT_NEAR(glm::dot(ground.normal_ecef, axes.east), 0, 1e-3);
}

TEST(TerrainHeight, WorksAcross180East) {
  const Quadcode node = Quadcode::Containing(10, 179.99, 5);
  const auto page = Slope(node, 500, 0);
  EXPECT_NEAR(GroundOnPage(*page, 10, 179.999).height_m, 500, 1);
  EXPECT_NEAR(GroundOnPage(*page, 10, 180.0).height_m, 500, 1);
}

TEST(TerrainHeight, TakesTheFinestPageThatIsInMemory) {
  LayerTable layers;
  layers.Add({"terrain", PageKind::kTerrain, 0, 6, [](Quadcode) { return true; }});
  const ManualClock clock;
  Paging paging(std::move(layers), size_t{1} << 24, clock);
  EXPECT_FALSE(GroundUnder(paging, kTerrain, 37, -118));
  paging.cache.Insert({kTerrain, Quadcode::Containing(37, -118, 2)}, Slope(Quadcode::Containing(37, -118, 2), 100, 0));
  ASSERT_TRUE(GroundUnder(paging, kTerrain, 37, -118));
  EXPECT_EQ(GroundUnder(paging, kTerrain, 37, -118)->level, 2);
  paging.cache.Insert({kTerrain, Quadcode::Containing(37, -118, 5)}, Slope(Quadcode::Containing(37, -118, 5), 300, 0));
  EXPECT_EQ(GroundUnder(paging, kTerrain, 37, -118)->level, 5);
  EXPECT_NEAR(GroundUnder(paging, kTerrain, 37, -118)->height_m, 300, 1);
}

}  // namespace
}  // namespace belvedere

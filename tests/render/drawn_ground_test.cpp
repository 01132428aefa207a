#include "render/drawn_ground.h"

#include "tests/render/synthetic_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace belvedere::testing {
namespace {

constexpr double kLater_s = 60;  // when every vertex is in its place

double Sloping(double latitude_deg, double longitude_deg) {
  return 1000 + 5000 * (latitude_deg - 10) - 3000 * std::remainder(longitude_deg - 180, 360.0);
}

// A list of nine quadnodes around the place.
struct Ground {
  Scene scene;
  DisplayList list;

  Ground(double latitude_deg, double longitude_deg, int level, const Height& height, int step) {
    const std::vector<Quadcode> nodes = Block(latitude_deg, longitude_deg, level, 3);
    for (const Quadcode node : nodes) scene.AddTerrain(node, height);
    AddSurface(list, scene, nodes, step);
  }
};

TEST(DrawnGround, IsTheHeightOfTheTrianglesAtThePlace) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(-0.04, 0.04);
  const Ground ground(10, 20, 10, Sloping, 8);
  for (int i = 0; i < 200; ++i) {
    const double latitude_deg = 10 + within(random), longitude_deg = 20 + within(random);
    const auto height_m = DrawnGroundAt(ground.list, {latitude_deg, longitude_deg, 0}, kLater_s);
    ASSERT_TRUE(height_m.has_value());
    EXPECT_NEAR(*height_m, Sloping(latitude_deg, longitude_deg), 0.05);
  }
}

TEST(DrawnGround, IsThatOfWhatIsDrawnAndNotOfThePage) {
  const auto spike = [](double latitude_deg, double) { return std::abs(latitude_deg - 10.0) < 1e-9 ? 500.0 : 0.0; };
  const Quadcode node = Quadcode::Containing(10, 20, 10);
  const double between_deg =
      node.Box().south_deg + 4.0 * node.HeightDegrees() / kCells;  // left out with every 8th post
  const Ground ground(
      between_deg, 20.01, 10,
      [&](double latitude_deg, double longitude_deg) {
        return spike(latitude_deg - between_deg + 10.0, longitude_deg);
      },
      8);
  EXPECT_NEAR(*DrawnGroundAt(ground.list, {between_deg, 20.01, 0}, kLater_s), 0.0, 1.0);
}

TEST(DrawnGround, IsFoundOnBothSidesOf180E) {
  const Ground ground(
      10, 179.999, 10, [](double, double) { return 700.0; }, 16);
  for (const double longitude_deg : {179.99, 180.0, -180.0})
    EXPECT_NEAR(DrawnGroundAt(ground.list, {10, longitude_deg, 0}, kLater_s).value_or(-1), 700.0, 0.2) << longitude_deg;
}

TEST(DrawnGround, IsFoundAtThePole) {
  const Ground ground(
      82.0, 30, 3, [](double, double) { return 2800.0; }, 1);
  EXPECT_NEAR(DrawnGroundAt(ground.list, {90, 30, 0}, kLater_s).value_or(-1), 2800.0, 5.0);
}

TEST(DrawnGround, IsWhereTheVerticesAreOnTheirWay) {
  Ground ground(
      10, 20, 10, [](double, double) { return 700.0; }, 8);
  for (TerrainDraw& draw : ground.list.terrain_draws) draw.rise_s = 2;
  for (ListVertex& vertex : *ground.list.vertices) vertex.rise_m = -300;
  EXPECT_NEAR(*DrawnGroundAt(ground.list, {10, 20, 0}, -1), 400.0, 0.2);
  EXPECT_NEAR(*DrawnGroundAt(ground.list, {10, 20, 0}, 0.5), 475.0, 0.2);
  EXPECT_NEAR(*DrawnGroundAt(ground.list, {10, 20, 0}, 2), 700.0, 0.2);
}

TEST(DrawnGround, IsNothingWhereNothingIsDrawn) {
  const Ground ground(10, 20, 10, Sloping, 8);
  EXPECT_FALSE(DrawnGroundAt(ground.list, {-40, 20, 0}, kLater_s).has_value());
  EXPECT_FALSE(DrawnGroundAt(DisplayList(), {10, 20, 0}, kLater_s).has_value());
}

}  // namespace
}  // namespace belvedere::testing

#include "managers/ground_bounds.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <random>

namespace belvedere {
namespace {

constexpr float kLowest_m = -4000, kHighest_m = 3000;

TerrainPage PageOf(Quadcode node) {
  TerrainPage page;
  page.node = node;
  page.min_height_m = kLowest_m;
  page.max_height_m = kHighest_m;
  return page;
}

class GroundBoundsTest : public testing::Test {
 protected:
  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  glm::dvec3 Direction() { return glm::normalize(glm::dvec3(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1))); }
  glm::dvec3 OnGround(Quadcode node) {
    const GeoBox box = node.Box();
    return ToEcef({Uniform(box.south_deg, box.north_deg), Uniform(box.west_deg, box.east_deg),
                   Uniform(double{kLowest_m}, double{kHighest_m})});
  }
  std::mt19937 random_{5};
};

// At both poles, beside them, where rows grow wide, and far from there.
const std::vector<Quadcode>& NodesToTry() {
  static const std::vector<Quadcode> kNodes{
      Quadcode::Containing(89, 10, 1),  Quadcode::Containing(89, 10, 3),     Quadcode::Containing(-89.99, 170, 6),
      Quadcode::Containing(80, -50, 3), Quadcode::Containing(-70, 100, 4),   Quadcode::Containing(67.6, 20, 5),
      Quadcode::Containing(50, 8, 4),   Quadcode::Containing(0.1, 179.9, 9), Quadcode::Containing(86, 3, 5)};
  return kNodes;
}

TEST_F(GroundBoundsTest, HoldAllOfTheGround) {
  for (const Quadcode node : NodesToTry()) {
    ASSERT_TRUE(GroundBounds::AreWorthTheirMaking(node));
    const GroundBounds bounds(PageOf(node));
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec3 point = OnGround(node), direction = Direction();
      const glm::dvec3 eye = point + Uniform(0, 1e6) * Direction();
      ASSERT_LE(bounds.LeastAlong(eye, direction), glm::dot(point - eye, direction) + 1e-3) << node.ToString();
      ASSERT_LE(bounds.DistanceTo(eye), glm::distance(point, eye) + 1e-3) << node.ToString();
    }
  }
}

// Seen from over the pole, what lies to the other side is beside the picture, though its sphere reaches over the pole.
TEST_F(GroundBoundsTest, ByAPoleTheyAreTighterThanASphere) {
  const Quadcode node = Quadcode::Containing(89, 22.5, 3);
  const GroundBounds bounds(PageOf(node));
  const glm::dvec3 eye = ToEcef({90, 0, 5000});
  const glm::dvec3 away = -glm::normalize(glm::dvec3(std::cos(M_PI / 8), std::sin(M_PI / 8), 0));
  double greatest_m = -1e9;
  for (int i = 0; i < 3000; ++i) greatest_m = std::max(greatest_m, glm::dot(OnGround(node) - eye, away));
  EXPECT_LE(greatest_m, 1.0);
  EXPECT_GT(bounds.LeastAlong(eye, -away), -2000) << "of a quadnode that is 600 km long";
}

}  // namespace
}  // namespace belvedere

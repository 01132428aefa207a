#include "managers/footing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

TEST(Footing, LandStandsShipsSwimAndTheRestIsWhereItSays) {
  EXPECT_EQ(FootingOf({1, 1, 0, 0, 0, 0, 0}), Footing::kGround);
  EXPECT_EQ(FootingOf({3, 1, 0, 0, 0, 0, 0}), Footing::kGround);
  EXPECT_EQ(FootingOf({1, 3, 0, 0, 0, 0, 0}), Footing::kSea);
  EXPECT_EQ(FootingOf({1, 2, 0, 0, 0, 0, 0}), Footing::kNone);
  EXPECT_EQ(FootingOf({1, 4, 0, 0, 0, 0, 0}), Footing::kNone);
  EXPECT_EQ(FootingOf({2, 1, 0, 0, 0, 0, 0}), Footing::kNone);  // a missile on its way to land targets
}

TEST(Footing, TheSeaIsTheGeoidsWhereItIsKnown) {
  const double south_of_india_m = SeaHeight(4.0, 79.0);
  EXPECT_TRUE(south_of_india_m == 0 || std::abs(south_of_india_m + 103) < 8) << south_of_india_m;
}

GroundPoint At(double height_m, int level) {
  return {height_m, glm::normalize(glm::dvec3(0.1 * level, 0, 1)), level};
}

TEST(GroundBlend, AChangeOfLevelIsNoHop) {
  GroundBlend blend;
  EXPECT_EQ(blend.Show(At(100, 8), 0.0).height_m, 100);
  double before_m = 100;
  glm::dvec3 normal = At(100, 8).normal_ecef;
  for (int i = 1; i <= 30; ++i) {
    const GroundPoint shown = blend.Show(At(110, 9), 0.02 * i);
    EXPECT_LT(std::abs(shown.height_m - before_m), 1.0);  // of ten metres in twenty frames
    EXPECT_LT(glm::distance(shown.normal_ecef, normal), 0.02);
    before_m = shown.height_m;
    normal = shown.normal_ecef;
  }
  EXPECT_NEAR(before_m, 110, 1e-9);
}

TEST(GroundBlend, AlongASlopeItFollowsAtOnce) {
  GroundBlend blend;
  blend.Show(At(100, 8), 0.0);
  EXPECT_EQ(blend.Show(At(103, 8), 0.05).height_m, 103);
}

TEST(GroundBlend, WhatWasNotSeenForASecondStandsWhereItStands) {
  GroundBlend blend;
  blend.Show(At(100, 8), 0.0);
  EXPECT_EQ(blend.Show(At(150, 9), 2.0).height_m, 150);
}

}  // namespace
}  // namespace belvedere

#include "managers/cluster_level.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <set>

namespace belvedere {
namespace {

constexpr ClusterKey kBlue{1, 1, 2}, kRed{2, 1, 2};

ClusterUnit Unit(uint64_t id, double x_m, ClusterKey key = kBlue) {
  return {id, key, {6.4e6 + x_m, 0, 0}, 1};
}

TEST(ClusterLevel, UnitsWithinTheThresholdAreTogether) {
  ClusterLevel level(1000);
  const std::vector<ClusterUnit> units = {Unit(1, 0), Unit(2, 600), Unit(3, 5000), Unit(4, 300, kRed)};
  const auto cluster = level.Update(units);
  EXPECT_EQ(cluster[0], cluster[1]);
  EXPECT_NE(cluster[0], cluster[2]);
  EXPECT_NE(cluster[0], cluster[3]);  // another force
  EXPECT_EQ(level.cluster_count(), 3u);
}

TEST(ClusterLevel, AClusterKeepsItsIdAndItsUnitsUntilTheyAreWellOutside) {
  ClusterLevel level(1000);
  std::vector<ClusterUnit> units = {Unit(1, 0), Unit(2, 200), Unit(3, 800)};
  level.Update(units);
  ASSERT_EQ(level.cluster_count(), 1u);
  const uint64_t id = level.id(0);
  units[2] = Unit(3, 1700);  // 1067 m from the middle: further than it may be to join, not far enough to leave
  level.Update(units);
  EXPECT_EQ(level.cluster_count(), 1u);
  units[2] = Unit(3, 2600);
  level.Update(units);
  EXPECT_EQ(level.cluster_count(), 2u);
  EXPECT_EQ(level.id(0), id);
}

TEST(ClusterLevel, ClustersThatComeCloseMerge) {
  ClusterLevel level(1000);
  std::vector<ClusterUnit> units = {Unit(1, 0), Unit(2, 100), Unit(3, 3000)};
  level.Update(units);
  ASSERT_EQ(level.cluster_count(), 2u);
  const uint64_t heavier = level.id(0);
  units[2] = Unit(3, 900);  // near, but not at half of the threshold
  level.Update(units);
  EXPECT_EQ(level.cluster_count(), 2u);
  units[2] = Unit(3, 400);
  const auto cluster = level.Update(units);
  EXPECT_EQ(level.cluster_count(), 1u);
  EXPECT_EQ(level.id(0), heavier);
  EXPECT_EQ(cluster[2], 0u);
}

TEST(ClusterLevel, UnitsThatAreGoneLeaveNothing) {
  ClusterLevel level(1000);
  level.Update(std::vector<ClusterUnit>{Unit(1, 0)});
  level.Update(std::vector<ClusterUnit>{});
  EXPECT_EQ(level.cluster_count(), 0u);
}

TEST(ClusterLevel, FormationsThatFlyPastEachOtherDoNotFlicker) {
  // Two hundred formations of five, each its own way over 300 km: no unit ever changes its cluster but by merging.
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-150e3, 150e3), speed(-250, 250), near(-200, 200);
  struct Formation {
    glm::dvec3 at, velocity;
  };
  std::vector<Formation> formations(200);
  for (Formation& one : formations) one = {{6.4e6, place(random), place(random)}, {0, speed(random), speed(random)}};
  std::vector<glm::dvec3> offsets(1000);
  for (glm::dvec3& offset : offsets) offset = {0, near(random), near(random)};
  ClusterLevel level(1000);
  std::map<uint64_t, uint64_t> before;
  int changes = 0;
  for (int step = 0; step < 60; ++step) {
    std::vector<ClusterUnit> units;
    for (size_t i = 0; i < offsets.size(); ++i) {
      const Formation& one = formations[i / 5];
      units.push_back({i + 1, kBlue, one.at + 0.5 * step * one.velocity + offsets[i], 1});
    }
    const auto cluster = level.Update(units);
    std::map<uint64_t, uint64_t> now;
    std::set<uint64_t> alive;
    for (size_t i = 0; i < level.cluster_count(); ++i) alive.insert(level.id(i));
    for (size_t i = 0; i < units.size(); ++i) {
      const glm::dvec3 off = units[i].position_ecef - units[i / 5 * 5].position_ecef;
      ASSERT_LT(glm::length(off), 1500);
      now[units[i].id] = level.id(cluster[i]);
      const auto was = before.find(units[i].id);
      if (was != before.end() && was->second != now[units[i].id] && alive.contains(was->second)) ++changes;
    }
    before.swap(now);
  }
  EXPECT_LT(changes, 1000 * 60 / 100);
}

}  // namespace
}  // namespace belvedere

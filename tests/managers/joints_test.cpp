#include "managers/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace belvedere {
namespace {

ObjectRecord Tank() {
  ObjectRecord record;
  record.type = {1, 1, 225, 1, 1, 3, 0};
  record.kinematics.time_s = 10;
  return record;
}

void AddPart(ObjectRecord& record, uint32_t type, float value) {
  record.part_array[record.part_count++] = {0, type, value};
}

TEST(Joints, TurretAndGunStandAsTheirPartsSayAndGoOnByTheirRates) {
  ObjectRecord record = Tank();
  AddPart(record, 4096 + 11, 0.5F);
  AddPart(record, 4096 + 12, 0.1F);
  AddPart(record, 4416 + 13, 0.2F);
  EXPECT_NEAR(JointsAt(record, 10).pose.turret_rad, 0.5, 1e-6);
  EXPECT_NEAR(JointsAt(record, 12).pose.turret_rad, 0.7, 1e-6);
  EXPECT_NEAR(JointsAt(record, 12).pose.gun_rad, 0.2, 1e-6);
  EXPECT_LE(std::abs(JointsAt(record, 1e6).pose.turret_rad), 3.15);
}

TEST(Joints, WhatIsNoNumberIsNotTaken) {
  ObjectRecord record = Tank();
  AddPart(record, 4096 + 11, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(JointsAt(record, 10).pose.turret_rad, 0);
}

TEST(Joints, GearAndHatchFollowPartsAndAppearance) {
  ObjectRecord tank = Tank();
  EXPECT_EQ(JointsAt(tank, 10).pose.open, 1);
  tank.appearance = 4 << 9;
  EXPECT_EQ(JointsAt(tank, 10).pose.open, 0);
  ObjectRecord aircraft = Tank();
  aircraft.type.domain = 2;
  EXPECT_EQ(JointsAt(aircraft, 10).pose.open, 0);
  aircraft.appearance = 1 << 25;
  EXPECT_EQ(JointsAt(aircraft, 10).pose.open, 1);
  AddPart(aircraft, 3072 + 1, 0.25F);  // the part knows better
  EXPECT_NEAR(JointsAt(aircraft, 10).pose.open, 0.25, 1e-6);
}

TEST(Joints, RotorsTurnWhileTheEngineRuns) {
  ObjectRecord record = Tank();
  EXPECT_EQ(JointsAt(record, 10).spin_radps, 0);
  record.appearance = 1 << 22;
  const JointsOf now = JointsAt(record, 10), later = JointsAt(record, 10.01);
  EXPECT_GT(now.spin_radps, 0);
  EXPECT_NEAR(std::remainder(later.pose.spin_rad - now.pose.spin_rad - 0.01 * now.spin_radps, 2 * M_PI), 0, 1e-4);
  record.appearance |= 3 << 3;  // destroyed
  EXPECT_EQ(JointsAt(record, 10).spin_radps, 0);
}

TEST(Joints, WhoLiesLies) {
  ObjectRecord soldier = Tank();
  soldier.type = {3, 1, 225, 1, 0, 0, 0};
  const glm::dmat3 axes(1.0);
  soldier.appearance = 1 << 16;
  EXPECT_EQ(PostureOf(soldier, axes).ecef_from_body, axes);
  soldier.appearance = 5 << 16;
  const glm::dmat3 lying = PostureOf(soldier, axes).ecef_from_body;
  EXPECT_EQ(-lying[2], axes[0]);  // head to where it looked
  EXPECT_EQ(lying[0], axes[2]);   // front to the ground
  EXPECT_NEAR(glm::determinant(lying), 1, 1e-12);
  EXPECT_EQ(PostureOf(Tank(), axes).ecef_from_body, axes);
}

TEST(Joints, WhoKneelsIsLowerThanWhoCrouches) {
  ObjectRecord soldier = Tank();
  soldier.type = {3, 1, 225, 1, 0, 0, 0};
  const glm::dmat3 axes(1.0);
  const auto lowered = [&](uint32_t state) {
    soldier.appearance = state << 16;
    const Posture posture = PostureOf(soldier, axes);
    EXPECT_EQ(posture.ecef_from_body, axes);
    return posture.lowered_m;
  };
  EXPECT_EQ(lowered(1), 0);  // upright
  EXPECT_GT(lowered(12), 0.2);
  EXPECT_GT(lowered(4), lowered(12));
  EXPECT_GT(lowered(10), lowered(4));
}

}  // namespace
}  // namespace belvedere

#include "managers/effects.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

using Shape = EffectInstance::Shape;
constexpr EntityType kTank{1, 1, 225, 1, 1, 3, 0}, kFighter{1, 2, 225, 1, 3, 3, 0}, kShip{1, 3, 225, 6, 0, 0, 0},
    kMissile{2, 1, 225, 1, 0, 0, 0}, kSoldier{3, 1, 225, 1, 0, 0, 0};

ObjectInstance Object(double speed_mps = 0) {
  const LevelAxes axes = LevelAxesAt(37, -118);
  ObjectInstance object;
  object.position_ecef = ToEcef({37, -118, 1000});
  object.ecef_from_body = glm::dmat3(axes.north, axes.east, -axes.up);
  object.velocity_mps = speed_mps * axes.north;
  object.radius_m = 5;
  return object;
}

std::vector<EffectInstance> Seen(const EntityType& type, uint32_t appearance, double now_s = 10, double speed_mps = 0,
                                 double day = 1) {
  std::vector<EffectInstance> effects;
  AddAppearance(AppearanceOf(type, appearance), type, Object(speed_mps), 7, {now_s, day}, effects);
  return effects;
}

TEST(Effects, BitsMeanWhatTheKindOfEntitySays) {
  EXPECT_TRUE(AppearanceOf(kTank, 1 << 5).smoke);
  EXPECT_TRUE(AppearanceOf(kTank, 1 << 12).head_lights);
  EXPECT_TRUE(AppearanceOf(kFighter, 1 << 12).landing_lights);
  EXPECT_FALSE(AppearanceOf(kTank, 1 << 16).afterburner);
  EXPECT_TRUE(AppearanceOf(kFighter, 1 << 16).afterburner);
  EXPECT_TRUE(AppearanceOf(kMissile, 1 << 16).afterburner);
  EXPECT_EQ(AppearanceOf(kMissile, 3 << 7).trail, 3);
  EXPECT_TRUE(AppearanceOf(kShip, 1 << 12).running_lights);
  EXPECT_FALSE(AppearanceOf(kSoldier, 0xFFFFFFFF).any());  // bit 5 on is how far it complies
  EXPECT_FALSE(AppearanceOf(kTank, 0).any());
}

TEST(Effects, SmokeRisesAndIsTheSameInEveryList) {
  const auto effects = Seen(kTank, 1 << 5, 10.3), again = Seen(kTank, 1 << 5, 10.3);
  ASSERT_GT(effects.size(), 5u);
  const double height_m = glm::length(Object().position_ecef);
  double highest_m = 0;
  for (size_t i = 0; i < effects.size(); ++i) {
    EXPECT_EQ(effects[i].shape, Shape::kPuff);
    EXPECT_EQ(effects[i].from_ecef, again[i].from_ecef);
    highest_m = std::max(highest_m, glm::length(effects[i].from_ecef) - height_m);
  }
  EXPECT_GT(highest_m, 8);
  // A puff a moment later is the same puff a little higher: its velocity says where.
  const auto later = Seen(kTank, 1 << 5, 10.35);
  const glm::dvec3 expected = effects[3].from_ecef + 0.05 * effects[3].velocity_mps;
  EXPECT_LT(glm::distance(later[3].from_ecef, expected), 0.1);
}

TEST(Effects, TrailsAreOfWhatMoves) {
  EXPECT_TRUE(Seen(kTank, 3 << 7, 10, 0).empty());
  EXPECT_FALSE(Seen(kTank, 3 << 7, 10, 10).empty());
  const auto small = Seen(kFighter, 1 << 7, 10, 200), large = Seen(kFighter, 3 << 7, 10, 200);
  ASSERT_EQ(small.size(), 2u);  // an engine on each side
  const auto length = [](const EffectInstance& effect) { return glm::distance(effect.from_ecef, effect.to_ecef); };
  EXPECT_NEAR(length(large[0]), 3 * length(small[0]), 1e-6);
  EXPECT_EQ(small[0].to_colour[3], 0);
}

TEST(Effects, LightsAreStrongerByNightAndOnTheirSides) {
  const auto day = Seen(kFighter, 1 << 13, 10, 0, 1), night = Seen(kFighter, 1 << 13, 10, 0, 0);
  ASSERT_EQ(night.size(), 3u);
  EXPECT_GT(night[0].from_colour[3], 2 * day[0].from_colour[3]);
  const glm::dvec3 right = Object().ecef_from_body[1];
  for (const EffectInstance& light : night) {
    EXPECT_EQ(light.shape, Shape::kGlow);
    EXPECT_GT(light.least_px, 0);
    const double side = glm::dot(light.from_ecef - Object().position_ecef, right);
    const auto [red, green, blue, alpha] = light.from_colour;
    EXPECT_EQ(red > green, side < -1) << side;  // red to the left
    EXPECT_EQ(green > red, side > 1) << side;   // green to the right; white at the tail
  }
}

TEST(Effects, AntiCollisionLightsFlash) {
  int on = 0;
  for (int i = 0; i < 100; ++i) on += Seen(kFighter, 1 << 14, 0.01 * i).empty() ? 0 : 1;
  EXPECT_GT(on, 5);
  EXPECT_LT(on, 20);
}

TEST(Effects, DamageDarkens) {
  EXPECT_EQ(ShadeOfDamage(0), 1.0F);
  for (uint32_t damage = 1; damage < 4; ++damage) EXPECT_LT(ShadeOfDamage(damage), ShadeOfDamage(damage - 1));
}

SceneEvent Event(SceneEvent::Kind kind, double end_s) {
  SceneEvent event;
  event.kind = kind;
  event.position_ecef = ToEcef({37, -118, 1000});
  event.velocity_mps = {500, 0, 0};
  event.start_s = 10;
  event.end_s = end_s;
  event.number = 3;
  return event;
}

TEST(Effects, EventsAreSeenFromTheirStartToTheirEnd) {
  for (const auto kind : {SceneEvent::Kind::kMuzzleFlash, SceneEvent::Kind::kTracer, SceneEvent::Kind::kExplosion,
                          SceneEvent::Kind::kDust, SceneEvent::Kind::kCollision}) {
    for (const double now_s : {9.9, 10.1, 13.0}) {
      std::vector<EffectInstance> effects;
      AddEvent(Event(kind, 12), now_s, std::nullopt, effects);
      EXPECT_EQ(effects.empty(), now_s != 10.1) << static_cast<int>(kind);
    }
  }
}

TEST(Effects, ATracerFlies) {
  std::vector<EffectInstance> effects;
  AddEvent(Event(SceneEvent::Kind::kTracer, 12), 10.5, std::nullopt, effects);
  ASSERT_EQ(effects.size(), 1u);
  EXPECT_NEAR(effects[0].from_ecef.x - Event(SceneEvent::Kind::kTracer, 12).position_ecef.x, 250, 1e-6);
}

TEST(Effects, AScorchLiesOnTheGroundWhereItIsKnown) {
  const SceneEvent event = Event(SceneEvent::Kind::kScorch, 310);
  std::vector<EffectInstance> effects;
  AddEvent(event, 100, std::nullopt, effects);
  EXPECT_TRUE(effects.empty());
  const glm::dvec3 up = LevelAxesAt(37, -118).up;
  AddEvent(event, 100, EffectGround{987, up}, effects);
  ASSERT_EQ(effects.size(), 1u);
  EXPECT_EQ(effects[0].shape, Shape::kDisc);
  EXPECT_NEAR(ToGeodetic(effects[0].from_ecef).height_m, 987, 0.5);
}

TEST(Effects, TrailsEndWhereTheyAreTooOldAndVectorsFollowDeadReckoning) {
  const ObjectInstance object = Object(100);
  std::vector<TrackPoint> track;
  for (int i = 0; i < 20; ++i)
    track.push_back({object.position_ecef - 100.0 * (20 - i) * glm::dvec3(0, 0, 1), 1.0 * i});
  std::vector<EffectInstance> effects;
  AddTrail(track, object, 20, 10, effects);
  EXPECT_EQ(effects.size(), 10u);
  EXPECT_GT(effects.front().from_colour[3], effects.back().to_colour[3]);
  EXPECT_EQ(effects[0].to_ecef, effects[1].from_ecef);
  effects.clear();
  KinematicState state;
  state.position_ecef = object.position_ecef;
  state.velocity_mps = object.velocity_mps;
  state.model = DeadReckoning::kFpw;
  AddVector(state, object, 0, 30, effects);
  ASSERT_FALSE(effects.empty());
  EXPECT_NEAR(glm::distance(effects.back().to_ecef, object.position_ecef), 3000, 1);
}

}  // namespace
}  // namespace belvedere

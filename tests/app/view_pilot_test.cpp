#include "runtime/app/view_pilot.h"

#include "runtime/app/target.h"
#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace belvedere {
namespace {

const GroundHeight kSea = [](double, double) { return 0.0; };

WindowSpec WindowOf(ViewKind kind) {
  WindowSpec window;
  window.width_px = 800;
  window.height_px = 600;
  window.view.kind = kind;
  window.view.position = {37, -118, 9'000};
  window.view.pitch_deg = -30;
  window.view.overview = {37, -118, 400e3};
  return window;
}

Pose FlyingEast() {
  const Geodetic place{37, -118, 8'000};
  const LevelAxes level = LevelAxesAt(place.latitude_deg, place.longitude_deg);
  return {ToEcef(place), glm::dmat3(level.east, -level.north, -level.up), level.east * 200.0};
}

ObjectRecord ObjectAt(uint16_t entity, uint8_t domain, const Geodetic& place, const char* marking) {
  ObjectRecord object;
  object.id = {1, 1, entity};
  object.type.kind = EntityType::kPlatform;
  object.type.domain = domain;
  object.kinematics.position_ecef = ToEcef(place);
  object.marking = Marking::Sanitise(std::string_view(marking));
  return object;
}

TEST(ViewPilotTest, PublishesWhatTheSpecSays) {
  WindowSpec window = WindowOf(ViewKind::kFree);
  window.view.error_px = 3;
  window.view.labels = false;
  ViewPilot pilot(5, window, {{"colour", {2}}, {"relief", {4, LayerRole::kMultiply}}});
  EXPECT_TRUE(pilot.TakeChanged());
  EXPECT_FALSE(pilot.TakeChanged());
  const ViewParameters view = pilot.Parameters(7, 1.5, 100);
  EXPECT_EQ(view.view, 5U);
  EXPECT_EQ(view.number, 7U);
  EXPECT_EQ(view.error_px, 3);
  EXPECT_EQ(view.image_layers.size(), 2U);
  EXPECT_FALSE(view.labels);
  EXPECT_LT(glm::distance(view.eye_ecef, ToEcef({37, -118, 9'000})), 1e-6);
}

TEST(ViewPilotTest, FreeViewFliesUntilTheKeyIsLetGo) {
  ViewPilot pilot(0, WindowOf(ViewKind::kFree), {});
  pilot.TakeChanged();
  pilot.Advance(1, std::nullopt, kSea);
  EXPECT_FALSE(pilot.TakeChanged());
  pilot.Apply(FlyCommand{1, 0, 0, 0, 0}, kSea);
  const glm::dvec3 before = pilot.camera().eye_ecef;
  pilot.Advance(1, std::nullopt, kSea);
  EXPECT_GT(glm::distance(pilot.camera().eye_ecef, before), 1'000);
  EXPECT_TRUE(pilot.TakeChanged());
  pilot.Apply(FlyCommand{}, kSea);
  pilot.Advance(1, std::nullopt, kSea);
  EXPECT_FALSE(pilot.TakeChanged());
  pilot.Apply(HomeCommand{}, kSea);
  EXPECT_LT(glm::distance(pilot.camera().eye_ecef, before), 1e-6);
}

TEST(ViewPilotTest, AnOrbitKeepsItsPivotWhileTheDragLasts) {
  ViewPilot pilot(0, WindowOf(ViewKind::kFree), {});
  const Lens lens{800, 600, Radians::FromDegrees(60)};
  const glm::dvec3 pivot = PointUnder(pilot.camera(), lens, {300, 400}, kSea);
  const double distance_m = glm::distance(pivot, pilot.camera().eye_ecef);
  for (int i = 0; i < 10; ++i) pilot.Apply(OrbitCommand{{300, 400}, 3, -2}, kSea);
  EXPECT_NEAR(glm::distance(pivot, pilot.camera().eye_ecef), distance_m, 1e-3);
}

TEST(ViewPilotTest, TetheredViewMovesWithItsTarget) {
  WindowSpec window = WindowOf(ViewKind::kTethered);
  window.view.tether = {150, 0, 10, true};
  ViewPilot pilot(0, window, {});
  pilot.Advance(0.02, std::nullopt, kSea);
  EXPECT_LT(glm::distance(pilot.camera().eye_ecef, ToEcef({37, -118, 9'000})), 1e-6);  // waits where the file says
  const Pose target = FlyingEast();
  pilot.Advance(0.02, target, kSea);
  EXPECT_NEAR(glm::distance(pilot.camera().eye_ecef, target.position_ecef), 150, 1e-6);
  EXPECT_EQ(pilot.Parameters(1, 0, 0).eye_velocity_mps, target.velocity_ecef_mps);
  pilot.Apply(ZoomCommand{{0, 0}, 1}, kSea);
  pilot.Advance(0.02, target, kSea);
  EXPECT_NEAR(glm::distance(pilot.camera().eye_ecef, target.position_ecef), 135, 1e-6);
  pilot.Advance(0.02, std::nullopt, kSea);  // the target is gone
  EXPECT_EQ(pilot.Parameters(2, 0, 0).eye_velocity_mps, glm::dvec3(0.0));
}

TEST(ViewPilotTest, OverviewIsOrthographicAndZooms) {
  ViewPilot pilot(0, WindowOf(ViewKind::kOverview), {});
  pilot.Apply(ZoomCommand{{400, 300}, 1}, kSea);
  const ViewParameters view = pilot.Parameters(1, 0, 0);
  EXPECT_EQ(view.projection, Projection::kOrthographic);
  EXPECT_NEAR(view.ortho_height_m, 360e3, 1e-6);
}

TEST(ViewPilotTest, SwitchesAndBoundChange) {
  ViewPilot pilot(0, WindowOf(ViewKind::kFree), {});
  pilot.TakeChanged();
  pilot.Apply(ToggleCommand{ViewSwitch::kHud}, kSea);
  pilot.Apply(ScaleErrorBoundCommand{0.5}, kSea);
  EXPECT_TRUE(pilot.TakeChanged());
  EXPECT_FALSE(pilot.Parameters(1, 0, 0).hud);
  EXPECT_EQ(pilot.Parameters(1, 0, 0).error_px, 1.0);
  pilot.Apply(ErrorBoundCommand{1e9}, kSea);
  EXPECT_EQ(pilot.Parameters(1, 0, 0).error_px, kMostError_px);
}

TEST(ViewPilotTest, TintsComeOneAfterAnother) {
  ViewPilot pilot(0, WindowOf(ViewKind::kFree), {});
  pilot.TakeChanged();
  pilot.Apply(TintCommand{GroundTint::kFrame}, kSea);
  EXPECT_TRUE(pilot.TakeChanged());
  EXPECT_EQ(pilot.Parameters(1, 0, 0).tint, GroundTint::kFrame);
  pilot.Apply(TintCommand{}, kSea);
  EXPECT_EQ(pilot.Parameters(1, 0, 0).tint, GroundTint::kImage);
  pilot.Apply(TintCommand{}, kSea);
  EXPECT_EQ(pilot.Parameters(1, 0, 0).tint, GroundTint::kNone);
}

TEST(ViewPilotTest, LayersChangeByNameAndByPlace) {
  ViewPilot pilot(0, WindowOf(ViewKind::kFree), {{"colour", {2}}, {"relief", {4, LayerRole::kMultiply}}});
  pilot.TakeChanged();
  pilot.Apply(LayerCommand{"relief", "opacity=0.25"}, kSea);
  pilot.Apply(LayerCommand{"1", "toggle"}, kSea);
  pilot.Apply(LayerCommand{"clouds", "off"}, kSea);  // of another view
  EXPECT_TRUE(pilot.TakeChanged());
  const std::vector<LayerUse> uses = pilot.Parameters(1, 0, 0).image_layers;
  EXPECT_FALSE(uses[0].on);
  EXPECT_TRUE(uses[1].on);
  EXPECT_FLOAT_EQ(uses[1].opacity, 0.25F);
}

TEST(TargetTest, RulesChoose) {
  ObjectSnapshot snapshot;
  snapshot.objects = {ObjectAt(1, EntityType::kLand, {37, -118, 1'000}, "TANK1"),
                      ObjectAt(2, EntityType::kAir, {10, 10, 1'000}, "FAR"),
                      ObjectAt(3, EntityType::kAir, {37.1, -118, 5'000}, "NEAR")};
  const glm::dvec3 start = ToEcef({37, -118, 9'000});
  const auto chosen = [&](const char* rule) {
    const ObjectRecord* object = ChooseTarget(*ParseTargetRule(rule), snapshot, start);
    return object == nullptr ? -1 : static_cast<int>(object->id.entity);
  };
  EXPECT_EQ(chosen("first air"), 2);
  EXPECT_EQ(chosen("nearest air"), 3);
  EXPECT_EQ(chosen("first ground"), 1);
  EXPECT_EQ(chosen("1:1:2"), 2);
  EXPECT_EQ(chosen("TANK1"), 1);
  EXPECT_EQ(chosen("9:9:9"), -1);
  EXPECT_FALSE(ParseTargetRule("").has_value());
  EXPECT_EQ(NextTarget(snapshot, {1, 1, 2}, 1)->id.entity, 3);
  EXPECT_EQ(NextTarget(snapshot, {1, 1, 3}, 1)->id.entity, 2);
  EXPECT_EQ(NextTarget(snapshot, {1, 1, 2}, -1)->id.entity, 3);
}

}  // namespace
}  // namespace belvedere

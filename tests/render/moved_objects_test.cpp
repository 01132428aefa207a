#include "render/moved_objects.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <numbers>

namespace belvedere {
namespace {

// Looks straight down on (0 N, 0 E), north up, from 10 km.
ViewParameters Down() {
  ViewParameters view;
  view.eye_ecef = ToEcef({0, 0, 10e3});
  view.ecef_from_camera = CameraAxes(0, 0, Radians{}, Radians::FromDegrees(-90), Radians{});
  view.width_px = 400;
  view.height_px = 300;
  return view;
}

DisplayList& Put(DisplayList& list, const Geodetic& where) {
  ObjectInstance instance;
  instance.position_ecef = ToEcef(where);
  instance.radius_m = 20;
  list.instances.push_back(instance);
  return list;
}

std::vector<MovedObject> Move(const DisplayList& list, const ViewParameters& view, double now_s) {
  const ViewMatrices matrices = MatricesOf(view, now_s, 9000);
  const InstanceRange all{0, static_cast<uint32_t>(list.instances.size())};
  return MoveObjects(list, {&all, 1}, view, matrices, now_s);
}

TEST(MovedObjects, IsWhereTheMatricesPutIt) {
  DisplayList list;
  Put(list, {0, 0, 1000});
  const auto moved = Move(list, Down(), 0);
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_NEAR(moved[0].screen_px.x, 200, 1e-3);
  EXPECT_NEAR(moved[0].screen_px.y, 150, 1e-3);
  EXPECT_NEAR(moved[0].distance_m, 9000, 1e-3);
  // 20 m at 9 km, 300 pixels over 60 degrees.
  EXPECT_NEAR(moved[0].radius_px, 20.0 / 9000 * 150 / std::tan(std::numbers::pi / 6), 1e-3);
}

TEST(MovedObjects, MovesOnWithItsVelocityAndTurns) {
  DisplayList list;
  Put(list, {0, 0, 0});
  list.time_s = 5;
  list.instances[0].velocity_mps = {0, 0, 100};  // north
  list.instances[0].angular_velocity_body = {0, 0, std::numbers::pi};
  const auto moved = Move(list, Down(), 5.5);
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_NEAR(moved[0].position_ecef.z, 50, 1e-9);
  EXPECT_LT(moved[0].screen_px.y, 150);
  // A quarter turn about z takes the nose from body x to body y.
  EXPECT_NEAR(glm::distance(moved[0].ecef_from_body[0], glm::dvec3(0, 1, 0)), 0, 1e-12);
}

TEST(MovedObjects, IsNotMovedOnForEver) {
  DisplayList list;
  Put(list, {0, 0, 0});
  list.instances[0].velocity_mps = {0, 0, 100};
  const auto moved = Move(list, Down(), 3600);
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_NEAR(moved[0].position_ecef.z, 100 * kLongestExtrapolation_s, 1e-9);
}

TEST(MovedObjects, NearestFirstAndHiddenOnesLeftOut) {
  DisplayList list;
  Put(list, {0, 0, 0});
  Put(list, {0, 0, 5000});
  Put(list, {5, 0, 0});     // beside the picture
  Put(list, {0, 180, 0});   // behind the Earth
  Put(list, {0, 0, 20e3});  // above the eye
  const auto moved = Move(list, Down(), 0);
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_EQ(moved[0].instance, 1U);
  EXPECT_EQ(moved[1].instance, 0U);
}

}  // namespace
}  // namespace belvedere

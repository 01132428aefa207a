#include "render/view_block.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/sun.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace belvedere {
namespace {

ViewParameters Overview(Projection projection) {
  ViewParameters view;
  view.eye_ecef = ToEcef({37, -118, 20e3});
  view.ecef_from_camera = CameraAxes(37, -118, Radians{}, Radians::FromDegrees(-90), Radians{});
  view.projection = projection;
  view.ortho_height_m = 50e3;
  return view;
}

TEST(ViewBlock, DepthAndDistanceAreInverse) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    const ViewMatrices matrices = MatricesOf(Overview(projection), 0, 18e3);
    for (const double distance_m : {5e3, 18e3, 20e3, 100e3, 400e3}) {
      const float depth = DepthAt(matrices.clip_from_camera, projection, distance_m);
      EXPECT_NEAR(AxisDistance(matrices.clip_from_camera, projection, depth), distance_m, 1e-3 * distance_m);
    }
    EXPECT_TRUE(std::isinf(AxisDistance(matrices.clip_from_camera, projection, 0.0F)));
  }
}

// A row's float matrix, made in double, takes a local point where the double matrix takes its ECEF position.
TEST(ViewBlock, FrameRowsAgreeWithDoubleMatrices) {
  const ViewMatrices matrices = MatricesOf(Overview(Projection::kPerspective), 0, 18e3);
  const Frame frame = FrameOf(Quadcode::Containing(37, -118, 12));
  const FrameRow row = MakeFrameRow(frame, matrices.clip_from_ecef);
  const glm::dvec3 local(1234.5, -2345.25, 210);
  const glm::dvec4 exact = matrices.clip_from_ecef * glm::dvec4(frame.ToEcef(local), 1.0);
  const glm::vec4 drawn = row.clip_from_frame * glm::vec4(glm::vec3(local), 1.0F);
  EXPECT_NEAR(drawn.x / drawn.w, exact.x / exact.w, 1e-6);
  EXPECT_NEAR(drawn.y / drawn.w, exact.y / exact.w, 1e-6);
  EXPECT_NEAR(drawn.w, exact.w, 1e-2);
  const glm::vec3 scaled{glm::dot(row.scaled_from_frame[0], glm::vec4(glm::vec3(local), 1.0F)),
                         glm::dot(row.scaled_from_frame[1], glm::vec4(glm::vec3(local), 1.0F)),
                         glm::dot(row.scaled_from_frame[2], glm::vec4(glm::vec3(local), 1.0F))};
  EXPECT_NEAR((glm::length(scaled) - 1) * 6371e3, ToGeodetic(frame.ToEcef(local)).height_m, 2);
}

TEST(ViewBlock, NightIsDarkButNotBlackAndAirGrowsWithDistance) {
  const ViewParameters view = Overview(Projection::kPerspective);
  const ViewMatrices matrices = MatricesOf(view, 0, 18e3);
  const glm::dvec3 up = UpAt(37, -118);
  const glm::dvec3 below = ToEcef({37, -118, 0});
  const Daylight day = DaylightAt(below, matrices, up);
  const Daylight night = DaylightAt(below, matrices, -up);
  EXPECT_NEAR(day.day, 1.0, 1e-6);
  EXPECT_NEAR(night.day, 0.12, 1e-6);
  EXPECT_GT(day.air.b, day.air.r);
  EXPECT_GT(day.air.b, 10 * night.air.b);
  const Daylight far = DaylightAt(ToEcef({38.5, -118, 0}), matrices, up);
  EXPECT_GT(far.air.b, 2 * day.air.b);
  EXPECT_LT(far.left, day.left);
}

}  // namespace
}  // namespace belvedere

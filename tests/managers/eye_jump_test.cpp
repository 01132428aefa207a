#include "managers/eye_jump.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

constexpr double kHeight_m = 3000;

ViewParameters ViewFrom(double latitude_deg, double heading_deg) {
  ViewParameters view;
  view.eye_ecef = ToEcef({latitude_deg, 10, kHeight_m});
  view.ecef_from_camera =
      CameraAxes(latitude_deg, 10, Radians::FromDegrees(heading_deg), Radians::FromDegrees(-20), {});
  return view;
}

class EyeJumpTest : public testing::Test {
 protected:
  bool Next(const ViewParameters& view, bool settled) { return jump_.Next(view, now_s_ += 0.03, kHeight_m, settled); }
  // A view that has come to rest at 20 N.
  void Rest() {
    Next(ViewFrom(20, 0), false);
    Next(ViewFrom(20, 0), true);
  }

  EyeJump jump_;
  double now_s_ = 1;
};

TEST_F(EyeJumpTest, ANewViewJumpsUntilItHasSettled) {
  EXPECT_TRUE(Next(ViewFrom(20, 0), false));
  EXPECT_TRUE(Next(ViewFrom(20, 0), false));
  EXPECT_FALSE(Next(ViewFrom(20, 0), true));
  EXPECT_FALSE(Next(ViewFrom(20, 0), false));
}

TEST_F(EyeJumpTest, FlyingAndTurningAreNoJumps) {
  Rest();
  for (int step = 1; step < 50; ++step) EXPECT_FALSE(Next(ViewFrom(20 + step * 1e-3, step * 5), false));
}

TEST_F(EyeJumpTest, FarAwayOrAnotherWayIsOne) {
  Rest();
  EXPECT_TRUE(Next(ViewFrom(20.1, 0), false));
  Next(ViewFrom(20.1, 0), true);
  EXPECT_TRUE(Next(ViewFrom(20.1, 90), false));
}

TEST_F(EyeJumpTest, AFastTargetTakesTheEyeAlong) {
  Rest();
  ViewParameters view = ViewFrom(20, 0);
  view.eye_velocity_mps = {0, 0, 30'000};
  view.time_s = now_s_;
  Next(view, true);
  for (int step = 0; step < 20; ++step) EXPECT_FALSE(Next(view, false));
}

TEST_F(EyeJumpTest, WhatDoesNotSettleGoesSmoothlyAfterAWhile) {
  EXPECT_TRUE(Next(ViewFrom(20, 0), false));
  now_s_ += EyeJump::kMost_s;
  EXPECT_FALSE(Next(ViewFrom(20, 0), false));
}

}  // namespace
}  // namespace belvedere

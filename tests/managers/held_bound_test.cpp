#include "managers/held_bound.h"

#include <gtest/gtest.h>

#include <cmath>

namespace belvedere {
namespace {

// A renderer whose frames take a fixed time and so much for each list's triangles, which grow as the bound shrinks.
class HeldBoundTest : public testing::Test {
 protected:
  HeldBoundTest() {
    view_.error_px = 1;
    view_.most_error_px = 8;
    view_.target_frame_ms = 25;
  }
  double Run(int lists) {
    for (int i = 0; i < lists; ++i) {
      const double bound_px = held_.Next(view_, report_, ++list_);
      bounds_px_.push_back(bound_px);
      ++report_.frame;
      report_.terrain_list = list_;
      report_.busy_ms = fixed_ms_ + per_bound_ms_ / bound_px;
    }
    return bounds_px_.back();
  }

  HeldBound held_;
  ViewParameters view_;
  FrameReport report_;
  uint64_t list_ = 0;
  double fixed_ms_ = 8, per_bound_ms_ = 40;
  std::vector<double> bounds_px_;
};

TEST_F(HeldBoundTest, WithoutATargetTheBoundIsTheOneAsked) {
  view_.target_frame_ms = 0;
  EXPECT_EQ(Run(50), 1.0);
}

TEST_F(HeldBoundTest, LoosensUntilFramesAreInTime) {
  const double bound_px = Run(100);
  EXPECT_LE(report_.busy_ms, 25.0);
  EXPECT_GE(report_.busy_ms, 0.75 * 25.0) << "looser than the target asks";
  EXPECT_GT(bound_px, 1.0);
}

TEST_F(HeldBoundTest, ComesToRest) {
  Run(100);
  bounds_px_.clear();
  Run(50);
  for (const double bound_px : bounds_px_) EXPECT_EQ(bound_px, bounds_px_.front());
}

TEST_F(HeldBoundTest, GoesBackToWhatWasAskedWhenThereIsTime) {
  Run(100);
  per_bound_ms_ = 2;
  EXPECT_EQ(Run(100), 1.0);
}

TEST_F(HeldBoundTest, StaysWithinTheLimit) {
  per_bound_ms_ = 1000;
  EXPECT_EQ(Run(200), 8.0);
  view_.most_error_px = 3;
  EXPECT_EQ(Run(1), 3.0);
}

TEST_F(HeldBoundTest, JudgesNoFrameOfAnEarlierBound) {
  report_.frame = 1;
  report_.terrain_list = 0;
  report_.busy_ms = 100;
  const double once = held_.Next(view_, report_, 1);
  EXPECT_EQ(once, 1.25);
  report_.frame = 2;  // still the list before
  EXPECT_EQ(held_.Next(view_, report_, 2), once);
  report_.frame = 3;
  report_.terrain_list = 1;
  EXPECT_GT(held_.Next(view_, report_, 3), once);
  EXPECT_EQ(held_.Next(view_, report_, 4), held_.Next(view_, report_, 5)) << "one frame is judged once";
}

}  // namespace
}  // namespace belvedere

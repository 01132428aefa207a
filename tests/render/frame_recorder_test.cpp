#include "render/frame_recorder.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

FrameSample Numbered(uint64_t frame) {
  FrameSample sample;
  sample.frame = frame;
  return sample;
}

TEST(FrameRecorder, GivesEachSampleOnceInOrder) {
  FrameRecorder recorder(10);
  recorder.Add(Numbered(1));
  recorder.Add(Numbered(2));
  const auto taken = recorder.Take();
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].frame, 1U);
  EXPECT_EQ(taken[1].frame, 2U);
  EXPECT_TRUE(recorder.Take().empty());
}

TEST(FrameRecorder, KeepsTheNewestWhenItIsFull) {
  FrameRecorder recorder(3);
  for (uint64_t frame = 1; frame <= 5; ++frame) recorder.Add(Numbered(frame));
  const auto taken = recorder.Take();
  ASSERT_EQ(taken.size(), 3U);
  EXPECT_EQ(taken.front().frame, 3U);
  EXPECT_EQ(taken.back().frame, 5U);
  EXPECT_EQ(recorder.lost(), 2U);
}

}  // namespace
}  // namespace belvedere

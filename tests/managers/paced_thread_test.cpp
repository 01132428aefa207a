#include "managers/paced_thread.h"

#include <gtest/gtest.h>

#include <semaphore>

namespace belvedere {
namespace {

TEST(PacedThread, RunsItsStepAgainAndAgain) {
  std::counting_semaphore<16> steps(0);
  PacedThread thread("test", 1000, [&] { steps.release(); });
  for (int i = 0; i < 5; ++i) steps.acquire();
}

TEST(PacedThread, EndsWithoutWaitingForItsPause) {
  std::binary_semaphore stepped(0);
  {
    // Once a day: the test would not end if destruction waited for the pause.
    PacedThread thread("test", 1.0 / 86'400, [&] { stepped.release(); });
    stepped.acquire();
  }
  SUCCEED();
}

TEST(PacedThread, LeavesCoresToOthersAndTakesHalfOfOneAtLeast) {
  EXPECT_EQ(ShareOfCore(1, 2), 0.5);
  EXPECT_EQ(ShareOfCore(2, 2), 1.0) << "one view on two cores";
  EXPECT_EQ(ShareOfCore(2, 4), 0.5);
  EXPECT_EQ(ShareOfCore(4, 2), 1.0);
  EXPECT_EQ(ShareOfCore(8, 16), 0.75);
  EXPECT_EQ(ShareOfCore(8, 32), 0.5);
  EXPECT_EQ(ShareOfCore(16, 8), 1.0);
}

}  // namespace
}  // namespace belvedere

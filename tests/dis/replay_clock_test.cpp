#include "dis/replay_clock.h"

#include <gtest/gtest.h>

namespace belvedere::dis {
namespace {

TEST(ReplayClock, GoesAtItsSpeed) {
  ReplayClock replay(2, 100);
  EXPECT_EQ(replay.DueAt(0), 100);
  EXPECT_EQ(replay.DueAt(10), 105);
  ASSERT_TRUE(replay.Obey("speed 10", 102).ok());  // at 4 s
  EXPECT_NEAR(*replay.DueAt(10), 102.6, 1e-9);
}

TEST(ReplayClock, PausesAndGoesOnWhereItWas) {
  ReplayClock replay(1, 100);
  ASSERT_TRUE(replay.Obey("pause", 103).ok());
  EXPECT_EQ(replay.DueAt(5), std::nullopt);
  EXPECT_EQ(replay.DueAt(2), std::nullopt);
  ASSERT_TRUE(replay.Obey("go", 150).ok());
  EXPECT_NEAR(*replay.DueAt(5), 152, 1e-9);
}

TEST(ReplayClock, StepsFromDatagramToDatagram) {
  ReplayClock replay(1, 100);
  ASSERT_TRUE(replay.Obey("step 2", 100).ok());
  EXPECT_EQ(replay.DueAt(7), 100);
  replay.Sent(7, 100);
  EXPECT_EQ(replay.DueAt(9), 100);
  replay.Sent(9, 101);
  EXPECT_EQ(replay.DueAt(12), std::nullopt);
  ASSERT_TRUE(replay.Obey("step", 105).ok());
  EXPECT_EQ(replay.DueAt(12), 105);
  replay.Sent(12, 105);
  ASSERT_TRUE(replay.Obey("go", 110).ok());
  EXPECT_NEAR(*replay.DueAt(15), 113, 1e-9);
}

TEST(ReplayClock, WhatIsNoCommandChangesNothing) {
  ReplayClock replay(1, 100);
  for (const char* bad : {"", "stop", "step x", "speed", "speed 0", "speed -1", "speed nan", "pause now"}) {
    EXPECT_NE(replay.Obey(bad, 101).message().find("there are pause, go, step"), std::string::npos) << bad;
  }
  EXPECT_EQ(replay.DueAt(10), 110);
}

}  // namespace
}  // namespace belvedere::dis

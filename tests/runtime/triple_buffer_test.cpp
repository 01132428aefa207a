#include "runtime/scene/triple_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

namespace belvedere {
namespace {

TEST(TripleBuffer, GivesTheNewestAndOnlyOnce) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.Fetch());
  buffer.back() = 1;
  buffer.Publish();
  buffer.back() = 2;
  buffer.Publish();
  ASSERT_TRUE(buffer.Fetch());
  EXPECT_EQ(buffer.front(), 2);
  EXPECT_FALSE(buffer.Fetch());
  EXPECT_EQ(buffer.front(), 2);
  buffer.back() = 3;
  EXPECT_FALSE(buffer.Fetch());  // not published
  buffer.Publish();
  ASSERT_TRUE(buffer.Fetch());
  EXPECT_EQ(buffer.front(), 3);
}

TEST(TripleBuffer, WhatIsReceivedIsShownLater) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.Receive());
  const auto publish = [&](int value) {
    buffer.back() = value;
    buffer.Publish();
  };
  publish(1);
  ASSERT_TRUE(buffer.Fetch());
  publish(2);
  ASSERT_TRUE(buffer.Receive());
  // However many follow meanwhile, both values of the consumer stay.
  for (const int value : {3, 4, 5, 6}) publish(value);
  EXPECT_EQ(buffer.front(), 1);
  EXPECT_EQ(buffer.coming(), 2);
  buffer.Show();
  EXPECT_EQ(buffer.front(), 2);
  ASSERT_TRUE(buffer.Fetch());
  EXPECT_EQ(buffer.front(), 6);
}

TEST(TripleBuffer, NeverShowsAHalfWrittenOrOlderValue) {
  constexpr int kValues = 100'000;
  TripleBuffer<std::array<int, 16>> buffer;
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (int value = 1; value <= kValues; ++value) {
      buffer.back().fill(value);
      buffer.Publish();
    }
    done = true;
  });
  int newest = 0;
  int wrong = 0;
  while (true) {
    const bool last = done;
    if (buffer.Fetch()) {
      const std::array<int, 16>& front = buffer.front();
      if (front[0] <= newest) ++wrong;
      for (const int value : front) wrong += value != front[0] ? 1 : 0;
      newest = front[0];
    } else if (last) {
      break;
    }
  }
  producer.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(newest, kValues);
}

}  // namespace
}  // namespace belvedere

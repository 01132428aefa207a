#include "dis/sender_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace belvedere::dis {
namespace {

constexpr double kUtc_s = 1.7e9;  // of arrival 0

// A sender's datagrams of true times 0, 0.1, ..: the timestamp that `stamp` gives, delayed by up to 80 ms. The worst
// difference between the state's time and the truth from settled_s on.
template <typename Stamp>
double WorstError(SenderClock& clock, double end_s, double settled_s, Stamp stamp) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> delay(0.0, 0.08);
  double worst_s = 0;
  for (double true_s = 0; true_s < end_s; true_s += 0.1) {
    const double arrival_s = true_s + 0.01 + delay(random);
    const double state_s = clock.StateTime(stamp(true_s), arrival_s, kUtc_s + arrival_s);
    if (true_s >= settled_s) worst_s = std::max(worst_s, std::abs(state_s - 0.01 - true_s));
  }
  return worst_s;
}

TEST(SenderClock, DelaysOfDatagramsDoNotShow) {
  SenderClock clock;
  const auto relative = [](double s) { return MakeTimestamp(1234.5 + s, false); };
  EXPECT_LT(WorstError(clock, 120, 10, relative), 0.006);
  EXPECT_TRUE(clock.keeps_pace());
}

TEST(SenderClock, TheHourMayWrap) {
  SenderClock clock;
  EXPECT_LT(WorstError(clock, 60, 10, [](double s) { return MakeTimestamp(3580.0 + s, false); }), 0.006);
  EXPECT_TRUE(clock.keeps_pace());
}

TEST(SenderClock, AnAbsoluteClockThatIsRightIsBelieved) {
  SenderClock clock;
  const double state_s = clock.StateTime(MakeTimestamp(kUtc_s + 9.7, true), 10.0, kUtc_s + 10.0);
  EXPECT_NEAR(state_s, 9.7, 1e-5);
  SenderClock ahead;
  EXPECT_NEAR(ahead.StateTime(MakeTimestamp(kUtc_s + 10.2, true), 10.0, kUtc_s + 10.0), 10.2, 1e-5);
}

TEST(SenderClock, AnAbsoluteClockThatIsWrongIsLearned) {
  for (const double wrong_s : {-600.0, -3.0, 40.0}) {
    SenderClock clock;
    EXPECT_LT(WorstError(clock, 60, 10, [&](double s) { return MakeTimestamp(kUtc_s + wrong_s + s, true); }), 0.006)
        << wrong_s;
  }
}

TEST(SenderClock, AClockMayRunALittleFastOrSlow) {
  for (const double pace : {0.9995, 1.0005}) {
    SenderClock clock;
    EXPECT_LT(WorstError(clock, 300, 10, [&](double s) { return MakeTimestamp(100 + pace * s, false); }), 0.05) << pace;
    EXPECT_TRUE(clock.keeps_pace());
  }
}

TEST(SenderClock, WhatIsNoClockCountsFromItsArrival) {
  std::mt19937 random(5);
  const auto constant = [](double) { return 0u; };
  const auto counter = [n = 0u](double) mutable { return n += 2; };
  const auto noise = [&](double) { return static_cast<uint32_t>(random()) & ~1u; };
  const auto fast = [](double s) { return MakeTimestamp(10 * s, false); };
  const auto slow = [](double s) { return MakeTimestamp(0.5 * s, false); };
  const auto check = [](auto stamp) {
    SenderClock clock;
    double worst_s = 0, worst_early_s = 0;
    for (double arrival_s = 0; arrival_s < 20; arrival_s += 0.1) {
      const double off_s = std::abs(clock.StateTime(stamp(arrival_s), arrival_s, kUtc_s + arrival_s) - arrival_s);
      (arrival_s < 3 ? worst_early_s : worst_s) = std::max(arrival_s < 3 ? worst_early_s : worst_s, off_s);
    }
    EXPECT_LE(worst_early_s, kProbation_s);
    EXPECT_LT(worst_s, 1e-9);
    EXPECT_FALSE(clock.keeps_pace());
  };
  check(constant);
  check(counter);
  check(noise);
  check(fast);
  check(slow);
}

TEST(SenderClock, AClockThatIsSetIsLearnedAnew) {
  SenderClock clock;
  const auto stamp = [](double s) { return MakeTimestamp(s < 30 ? 100 + s : s < 60 ? 900 + s : 5 + s, false); };
  EXPECT_LT(WorstError(clock, 29, 10, stamp), 0.006);
  SenderClock other;
  EXPECT_LT(WorstError(other, 120, 80, stamp), 0.006);
  EXPECT_TRUE(other.keeps_pace());
}

TEST(SenderClocks, AreBounded) {
  SenderClocks clocks;
  for (uint64_t host = 1; host <= 2 * SenderClocks::kMostSenders; ++host) {
    clocks.StateTime({host, 1, 1}, 0, static_cast<double>(host), kUtc_s);
  }
  EXPECT_EQ(clocks.size(), SenderClocks::kMostSenders);
}

}  // namespace
}  // namespace belvedere::dis

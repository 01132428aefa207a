// DIS timestamps.
//
// The upper 31 bits count units of 3600 s / 2^31 (1.676 us) past the hour and wrap with it; the lowest bit says whether
// the hour is that of UTC (absolute) or of the sender's own (relative).
// Threads: pure functions.
#pragma once

#include <cstdint>

namespace belvedere::dis {

constexpr bool IsAbsolute(uint32_t timestamp) {
  return (timestamp & 1) != 0;
}
constexpr double SecondsPastHour(uint32_t timestamp) {
  return (timestamp >> 1) * (3600.0 / 2147483648.0);
}
// Seconds of any size; only what is past the hour is kept.
uint32_t MakeTimestamp(double seconds, bool absolute);

// How long before its arrival a state may have been true by an absolute timestamp, and how far the sender's clock may
// be ahead (sender_clock.h).
inline constexpr double kLongestTransit_s = 5.0;
inline constexpr double kClockSkew_s = 0.5;

}  // namespace belvedere::dis

// DIS timestamps, and when the state in a PDU was true.
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

// When the state was true, on the clock of arrival_s. An absolute timestamp that lies at most kLongestTransit_s before
// or kClockSkew_s after the arrival is believed; others (relative, a clock that is off, a recording played again) are
// not, and the state is taken to be as of its arrival. utc_s is the arrival's time since 1970-01-01 UTC.
inline constexpr double kLongestTransit_s = 5.0;
inline constexpr double kClockSkew_s = 0.5;
double StateTime(uint32_t timestamp, double arrival_s, double utc_s);

}  // namespace belvedere::dis

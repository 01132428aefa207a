// SenderClock: one sender's clock related to ours, so that a state counts from when it was true and not from when it
// arrived.
//
// A sample is an arrival less its timestamp: the sender's zero on our clock, plus the delay of that datagram. The least
// sample of the last minute is the sender's zero with the least delay there is, which is taken to be none. What is more
// than it is the datagram's lateness, and that long ago its state was true.
//   - Absolute timestamps are believed outright while the least transit by this machine's UTC is plausible.
//   - A clock that is set, or starts again, is learned anew.
//   - A clock that does not keep pace with ours (a constant, a counter, a recording at another speed) is no clock: its
//     states count from their arrival. A clock is judged every kPace_s; until the first judgement it is believed up to
//     kProbation_s of lateness.
//
// Units:   seconds; results on the clock of arrival_s.
// Threads: belongs to its user.
#pragma once

#include "dis/timestamp.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

namespace belvedere::dis {

class SenderClock {
 public:
  // When the state in a PDU was true. Arrivals must not go back. utc_s: the arrival since 1970-01-01 UTC.
  double StateTime(uint32_t timestamp, double arrival_s, double utc_s);
  bool keeps_pace() const { return keeps_pace_; }

 private:
  struct Least {
    double sample_s = 0, transit_s = 0;
    bool any = false;
    void Take(double sample, double transit);
  };
  double Unwrap(double past_hour_s);
  void JudgePace(double stamp_s, double arrival_s);
  void StartAgain(double stamp_s, double arrival_s, double sample_s, double transit_s);
  void Learn(double sample_s, double transit_s, double arrival_s);

  bool started_ = false;
  double last_stamp_s_ = 0;     // unwrapped
  std::array<Least, 2> least_;  // of the half minute now, and of the one before
  double window_start_s_ = 0;
  double pace_stamp_s_ = 0, pace_arrival_s_ = 0;  // where the pace is measured from
  bool judged_ = false, keeps_pace_ = true;
};

inline constexpr double kPace_s = 2.0;
inline constexpr double kProbation_s = 0.5;

// The clocks of all senders, told apart by host and by site and application. At kMostSenders the one not heard of for
// longest is forgotten.
class SenderClocks {
 public:
  static constexpr size_t kMostSenders = 4096;
  struct Sender {
    uint64_t host = 0;
    uint16_t site = 0, application = 0;
    auto operator<=>(const Sender&) const = default;
  };
  double StateTime(const Sender& sender, uint32_t timestamp, double arrival_s, double utc_s);
  size_t size() const { return clocks_.size(); }

 private:
  struct Known {
    SenderClock clock;
    double heard_s = 0;
  };
  void ForgetStalest();
  std::map<Sender, Known> clocks_;
};

}  // namespace belvedere::dis

// ReplayClock: which moment of a recording it is: faster or slower than it was, paused, and from datagram to datagram.
//
// Units:   seconds: of the recording from its first datagram; of the user's clock otherwise.
// Threads: belongs to its user.
#pragma once

#include "runtime/base/status.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace belvedere::dis {

class ReplayClock {
 public:
  ReplayClock(double speed, double now_s) : speed_(speed), anchor_now_s_(now_s) {}
  // "pause", "go", "step", "step N", "speed X". The error names what is known.
  Status Obey(std::string_view command, double now_s);
  // When a datagram of that moment is to be sent; nullopt: not before somebody says so.
  std::optional<double> DueAt(double recording_s) const;
  // It was sent: one step less to go, and where it is paused the recording stands at that moment.
  void Sent(double recording_s, double now_s);
  bool paused() const { return paused_; }

 private:
  double MomentAt(double now_s) const;

  double speed_;
  double anchor_now_s_;            // it was this time
  double anchor_recording_s_ = 0;  // at this moment of the recording
  bool paused_ = false;
  uint64_t steps_ = 0;
};

}  // namespace belvedere::dis

// Clock: the one source of time, injected wherever time matters, so that tests decide what time it is.
//
// Units: seconds as double. Now() is monotonic from an arbitrary start; UtcSeconds() is seconds since 1970-01-01 UTC.
// Threads: any.
#pragma once

#include <atomic>

namespace belvedere {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual double NowSeconds() const = 0;
  virtual double UtcSeconds() const = 0;

  // The machine's own clock; lives for ever.
  static const Clock& System();
};

// A clock that stands still until told otherwise.
class ManualClock final : public Clock {
 public:
  explicit ManualClock(double utc_start_s = 0) : utc_start_s_(utc_start_s) {}
  double NowSeconds() const override { return now_s_.load(); }
  double UtcSeconds() const override { return utc_start_s_ + now_s_.load(); }
  void Advance(double seconds) { now_s_.store(now_s_.load() + seconds); }

 private:
  const double utc_start_s_;
  std::atomic<double> now_s_{0};
};

}  // namespace belvedere

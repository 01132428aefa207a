// Interruption: waiting that ends when the user interrupts the program (SIGINT, SIGTERM).
//
// Make one before any thread starts: threads inherit that these signals are blocked, and only WaitUntil takes them.
#pragma once

#include "runtime/base/clock.h"

#include <signal.h>

#include <cmath>
#include <ctime>

namespace belvedere::dis {

class Interruption {
 public:
  Interruption() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }
  // True when the time has come, false when interrupted before.
  bool WaitUntil(double time_s, const Clock& clock) {
    while (!interrupted_) {
      const double left_s = time_s - clock.NowSeconds();
      const bool due = left_s <= 0;
      const double wait_s = due ? 0.0 : std::fmin(left_s, 3600.0);
      timespec wait{};
      wait.tv_sec = static_cast<time_t>(wait_s);
      wait.tv_nsec = static_cast<long>((wait_s - std::floor(wait_s)) * 1e9);
      interrupted_ = sigtimedwait(&signals_, nullptr, &wait) > 0;
      if (due) break;
    }
    return !interrupted_;
  }
  bool interrupted() const { return interrupted_; }

 private:
  sigset_t signals_;
  bool interrupted_ = false;
};

}  // namespace belvedere::dis

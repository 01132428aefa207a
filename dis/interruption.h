// Interruption: waiting that ends when the user interrupts the program (SIGINT, SIGTERM).
//
// Make one before any thread starts: threads inherit that these signals are blocked, and only WaitUntil takes them.
#pragma once

#include "runtime/base/clock.h"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <optional>

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
  // Waits for the time, or for something to read from standard input while `input` is true; nullopt: for ever.
  enum class Wake : uint8_t { kTime, kInput, kInterrupted };
  Wake WaitUntilOrInput(std::optional<double> time_s, const Clock& clock, bool input) {
    const int signals = signalfd(-1, &signals_, SFD_CLOEXEC);
    Wake wake = Wake::kTime;
    while (!interrupted_) {
      const double left_s = time_s ? *time_s - clock.NowSeconds() : 3600.0;
      if (left_s <= 0) break;
      const double wait_s = std::fmin(left_s, 3600.0);
      timespec wait{static_cast<time_t>(wait_s), static_cast<long>((wait_s - std::floor(wait_s)) * 1e9)};
      std::array<pollfd, 2> sources = {{{signals, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}}};
      if (ppoll(sources.data(), input ? 2 : 1, &wait, nullptr) <= 0) continue;
      interrupted_ = sources[0].revents != 0;
      if (sources[1].revents == 0) continue;
      wake = Wake::kInput;
      break;
    }
    close(signals);
    return interrupted_ ? Wake::kInterrupted : wake;
  }
  bool interrupted() const { return interrupted_; }

 private:
  sigset_t signals_;
  bool interrupted_ = false;
};

}  // namespace belvedere::dis

#include "preproc/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

namespace belvedere {

Progress::Progress(int64_t planned, const Clock& clock, std::function<Written()> written)
    : planned_(std::max<int64_t>(planned, 1)),
      clock_(clock),
      written_(std::move(written)),
      start_s_(clock.NowSeconds()),
      thread_([this] { Run(); }) {}

Progress::~Progress() {
  {
    const MutexLock lock(mutex_);
    stop_ = true;
    stopped_.NotifyAll();
  }
  thread_.join();
}

void Progress::Run() {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const double period_s = terminal ? 0.25 : 3.0;
  double next_s = start_s_ + period_s;
  for (;;) {
    {
      const MutexLock lock(mutex_);
      if (!stop_) stopped_.WaitFor(mutex_, std::chrono::milliseconds(100));
      if (stop_) break;
    }
    if (clock_.NowSeconds() < next_s) continue;
    next_s += period_s;
    Print(terminal);
  }
  if (terminal) std::fputs("\r\033[K", stderr);
}

void Progress::Print(bool terminal) const {
  const double elapsed_s = std::max(clock_.NowSeconds() - start_s_, 1e-3);
  const int64_t done = done_.load(std::memory_order_relaxed);
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(planned_));
  const int left_s = done > 0 ? static_cast<int>(elapsed_s * (1.0 - share) / share) : 0;
  const Written written = written_();
  const std::string line = fmt::format("{:.0f} %, {} pages, {:.0f} pages/s, {:.1f} MB/s, {}:{:02} left", 100 * share,
                                       written.pages, static_cast<double>(written.pages) / elapsed_s,
                                       static_cast<double>(written.bytes) / 1e6 / elapsed_s, left_s / 60, left_s % 60);
  fmt::print(stderr, "{}{}{}", terminal ? "\r\033[K" : "", line, terminal ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace belvedere

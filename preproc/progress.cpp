#include "preproc/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

namespace belvedere {
namespace {

// "0:22", "1:02:03"
std::string TimeText(double seconds) {
  const auto whole = static_cast<int64_t>(std::ceil(seconds));
  const int64_t minutes = whole / 60;
  return minutes < 60 ? fmt::format("{}:{:02}", minutes, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", minutes / 60, minutes % 60, whole % 60);
}

}  // namespace

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

std::string Progress::Line(int64_t done, int64_t planned, double elapsed_s, const Written& written) {
  elapsed_s = std::max(elapsed_s, 1e-3);
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(planned));
  return fmt::format("{:.0f} %, {} pages, {:.0f} pages/s, {:.1f} MB/s, {}", std::floor(100 * share), written.pages,
                     static_cast<double>(written.pages) / elapsed_s,
                     static_cast<double>(written.bytes) / 1e6 / elapsed_s,
                     done > 0 ? TimeText(elapsed_s * (1 - share) / share) + " left" : "time left not known yet");
}

void Progress::Print(bool terminal) const {
  const std::string line =
      Line(done_.load(std::memory_order_relaxed), std::max<int64_t>(planned_.load(std::memory_order_relaxed), 1),
           clock_.NowSeconds() - start_s_, written_());
  fmt::print(stderr, "{}{}{}", terminal ? "\r\033[K" : "", line, terminal ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace belvedere

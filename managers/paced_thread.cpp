#include "managers/paced_thread.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace belvedere {
namespace {

using SteadyClock = std::chrono::steady_clock;

}  // namespace

PacedThread::PacedThread(const char* name, double most_per_second, std::function<void()> step)
    : step_(std::move(step)), thread_([this, name, most_per_second] { Run(name, 1.0 / most_per_second); }) {}

PacedThread::~PacedThread() {
  {
    const MutexLock lock(mutex_);
    ending_ = true;
  }
  ended_.NotifyAll();
  thread_.join();
}

void PacedThread::Run(const char* name, double period_s) {
  pthread_setname_np(pthread_self(), name);
  double pause_s = 0;
  while (Pause(pause_s)) {
    const auto begin = SteadyClock::now();
    step_();
    pause_s = std::max(0.0, period_s - std::chrono::duration<double>(SteadyClock::now() - begin).count());
  }
}

bool PacedThread::Pause(double seconds) {
  const auto until =
      SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(seconds));
  const MutexLock lock(mutex_);
  while (!ending_) {
    const auto left = until - SteadyClock::now();
    if (left <= SteadyClock::duration::zero()) return true;
    ended_.WaitFor(mutex_, left);
  }
  return false;
}

}  // namespace belvedere

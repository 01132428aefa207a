#include "managers/paced_thread.h"

#include "runtime/base/trace.h"

#include <pthread.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

namespace belvedere {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr double kCoresForOthers = 2;  // drawing and page servers
std::atomic<int> living_threads{0};

// What the thread has had of a core, so that a step that others kept waiting is not taken for a long one.
double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double ShareOfCore(int cores, int threads) {
  // They come in pairs, a terrain and an object manager for each view, and the second has little to do.
  const double pairs = std::max(threads, 1) / 2.0;
  return std::clamp(std::max(cores - kCoresForOthers, cores / 2.0) / pairs, 0.5, 1.0);
}

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
  Trace::NameThread(name);
  ++living_threads;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  double pause_s = 0;
  while (Pause(pause_s)) {
    const auto begin = SteadyClock::now();
    const double cpu_before_s = CpuSeconds();
    step_();
    const double busy_s = CpuSeconds() - cpu_before_s;
    const double gone_s = std::chrono::duration<double>(SteadyClock::now() - begin).count();
    // A step that takes long comes less often.
    const double pause_per_busy = 1.0 / ShareOfCore(cores, living_threads) - 1.0;
    pause_s = std::max(period_s - gone_s, pause_per_busy * busy_s);
  }
  --living_threads;
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

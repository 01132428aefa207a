// PacedThread: runs a step again and again on a thread of its own, at most so many times a second, until destroyed. All
// such threads together leave two of the machine's cores to others, or half of them where there are fewer than four;
// but each may take half of a core.
//
// Threads: constructed and destroyed by one thread; destroying waits for the step that is running, and for no pause.
#pragma once

#include "runtime/base/mutex.h"

#include <functional>
#include <thread>

namespace belvedere {

// The share of a core that each of so many threads may take, 0.5 to 1.
double ShareOfCore(int cores, int threads);

class PacedThread {
 public:
  // name: at most 15 letters, shown by the system's tools.
  PacedThread(const char* name, double most_per_second, std::function<void()> step);
  ~PacedThread();
  PacedThread(const PacedThread&) = delete;
  PacedThread& operator=(const PacedThread&) = delete;

 private:
  void Run(const char* name, double period_s);
  // Waits until the time has come; false when it is time to end.
  bool Pause(double seconds) EXCLUDES_LOCK(mutex_);

  const std::function<void()> step_;
  Mutex mutex_;
  CondVar ended_;
  bool ending_ GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace belvedere

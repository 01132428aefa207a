// Progress: how far a build or an export is, its rate and the time left, on standard error.
//
// On a terminal one line that is written over, elsewhere a line every few seconds.
//
// Threads: Done and Spare, any. A thread of its own prints until the Progress goes.
#pragma once

#include "runtime/base/clock.h"
#include "runtime/base/mutex.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace belvedere {

class Progress {
 public:
  struct Written {
    int64_t pages = 0, bytes = 0;
  };
  // planned: steps until all is done, Done counts them, Spare takes some of them away. written: what has reached the
  // dataset, or the file, so far.
  Progress(int64_t planned, const Clock& clock, std::function<Written()> written);
  ~Progress();
  // "12 %, 1371 pages, 455 pages/s, 10.9 MB/s, 0:22 left": the rates so far, and the time left if the steps go on so.
  // REQUIRES: planned > 0
  static std::string Line(int64_t done, int64_t planned, double elapsed_s, const Written& written);
  void Done() { done_.fetch_add(1, std::memory_order_relaxed); }
  // So many need not be done after all.
  void Spare(int64_t steps) { planned_.fetch_sub(steps, std::memory_order_relaxed); }

 private:
  void Run() EXCLUDES_LOCK(mutex_);
  void Print(bool terminal) const;

  std::atomic<int64_t> planned_;
  const Clock& clock_;
  const std::function<Written()> written_;
  const double start_s_;
  std::atomic<int64_t> done_{0};
  Mutex mutex_;
  CondVar stopped_;
  bool stop_ GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace belvedere

// Progress: how far a build is, its rate and the time left, on standard error.
//
// On a terminal one line that is written over, elsewhere a line every few seconds.
//
// Threads: Done, any. A thread of its own prints until the Progress goes.
#pragma once

#include "runtime/base/clock.h"
#include "runtime/base/mutex.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

namespace belvedere {

class Progress {
 public:
  // written_bytes: what has reached the dataset so far.
  Progress(int64_t planned_pages, const Clock& clock, std::function<int64_t()> written_bytes);
  ~Progress();
  void Done() { done_.fetch_add(1, std::memory_order_relaxed); }

 private:
  void Run() EXCLUDES_LOCK(mutex_);
  void Print(bool terminal) const;

  const int64_t planned_pages_;
  const Clock& clock_;
  const std::function<int64_t()> written_bytes_;
  const double start_s_;
  std::atomic<int64_t> done_{0};
  Mutex mutex_;
  CondVar stopped_;
  bool stop_ GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace belvedere

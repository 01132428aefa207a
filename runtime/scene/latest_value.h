// LatestValue: the newest of a series of immutable values, for any number of readers.
//
// Threads: any. A reader holds what it got for as long as it likes; the lock is held for a pointer copy.
#pragma once

#include "runtime/base/mutex.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace belvedere {

template <typename T>
class LatestValue {
 public:
  explicit LatestValue(T first = T{}) : value_(std::make_shared<const T>(std::move(first))) {}

  void Publish(T value) {
    auto next = std::make_shared<const T>(std::move(value));
    {
      const MutexLock lock(mutex_);
      value_.swap(next);
      ++version_;
    }
  }
  std::shared_ptr<const T> Get() const {
    const MutexLock lock(mutex_);
    return value_;
  }
  uint64_t version() const {
    const MutexLock lock(mutex_);
    return version_;
  }

 private:
  mutable Mutex mutex_;
  std::shared_ptr<const T> value_ GUARDED_BY(mutex_);
  uint64_t version_ GUARDED_BY(mutex_) = 0;
};

}  // namespace belvedere

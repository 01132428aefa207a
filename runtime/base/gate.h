// Gate: lets many work at once, and now and then one alone.
//
// Those who work pass through with a GatePass. Whoever closes the gate waits until all who are inside are gone; who
// comes meanwhile waits until it is opened. A pass is not taken while one is held by the same thread.
//
// A readers-writer lock that prefers the writer: std::shared_mutex here prefers readers, so that servers which are
// never idle would keep a writer waiting for ever.
//
// Threads: any; one closes at a time.
#pragma once

#include "runtime/base/mutex.h"

namespace belvedere {

class Gate {
 public:
  void Enter() EXCLUDES_LOCK(mutex_) {
    const MutexLock lock(mutex_);
    while (closed_) changed_.Wait(mutex_);
    ++inside_;
  }
  void Leave() EXCLUDES_LOCK(mutex_) {
    const MutexLock lock(mutex_);
    if (--inside_ == 0 && closed_) changed_.NotifyAll();
  }
  void Close() EXCLUDES_LOCK(mutex_) {
    const MutexLock lock(mutex_);
    closed_ = true;
    while (inside_ > 0) changed_.Wait(mutex_);
  }
  void Open() EXCLUDES_LOCK(mutex_) {
    const MutexLock lock(mutex_);
    closed_ = false;
    changed_.NotifyAll();
  }

 private:
  Mutex mutex_;
  CondVar changed_;
  int inside_ GUARDED_BY(mutex_) = 0;
  bool closed_ GUARDED_BY(mutex_) = false;
};

class GatePass {
 public:
  explicit GatePass(Gate& gate) : gate_(gate) { gate_.Enter(); }
  ~GatePass() { gate_.Leave(); }
  GatePass(const GatePass&) = delete;
  GatePass& operator=(const GatePass&) = delete;

 private:
  Gate& gate_;
};

}  // namespace belvedere

// Mutex, MutexLock and CondVar that clang's thread-safety analysis understands.
//
// Every member that a mutex guards says GUARDED_BY(mutex_); `./check` compiles with -Wthread-safety as an error.
// No call-out, I/O or free of anything large under a lock; waits are on a CondVar, never a sleeping poll.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

#if defined(__clang__)
#define BELVEDERE_TSA(x) __attribute__((x))
#else
#define BELVEDERE_TSA(x)
#endif
#define CAPABILITY(x) BELVEDERE_TSA(capability(x))
#define SCOPED_CAPABILITY BELVEDERE_TSA(scoped_lockable)
#define GUARDED_BY(x) BELVEDERE_TSA(guarded_by(x))
#define PT_GUARDED_BY(x) BELVEDERE_TSA(pt_guarded_by(x))
#define REQUIRES_LOCK(...) BELVEDERE_TSA(requires_capability(__VA_ARGS__))
#define EXCLUDES_LOCK(...) BELVEDERE_TSA(locks_excluded(__VA_ARGS__))
#define ACQUIRES_LOCK(...) BELVEDERE_TSA(acquire_capability(__VA_ARGS__))
#define RELEASES_LOCK(...) BELVEDERE_TSA(release_capability(__VA_ARGS__))
#define NO_THREAD_SAFETY_ANALYSIS BELVEDERE_TSA(no_thread_safety_analysis)

namespace belvedere {

class CAPABILITY("mutex") Mutex {
 public:
  void Lock() ACQUIRES_LOCK() { mutex_.lock(); }
  void Unlock() RELEASES_LOCK() { mutex_.unlock(); }

 private:
  friend class CondVar;
  std::mutex mutex_;
};

class SCOPED_CAPABILITY MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) ACQUIRES_LOCK(mutex) : mutex_(mutex) { mutex_.Lock(); }
  ~MutexLock() RELEASES_LOCK() { mutex_.Unlock(); }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

 private:
  Mutex& mutex_;
};

// Waits may return early; callers loop on their condition.
class CondVar {
 public:
  void Wait(Mutex& mutex) REQUIRES_LOCK(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    condition_.wait(lock);
    lock.release();
  }
  void WaitFor(Mutex& mutex, std::chrono::nanoseconds longest) REQUIRES_LOCK(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    condition_.wait_for(lock, longest);
    lock.release();
  }
  void NotifyOne() { condition_.notify_one(); }
  void NotifyAll() { condition_.notify_all(); }

 private:
  std::condition_variable condition_;
};

}  // namespace belvedere

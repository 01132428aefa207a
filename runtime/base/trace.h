// Trace: what each thread did and when, as spans and counters, kept in one bounded ring and written as Chrome
// trace-event JSON, which chrome://tracing and Perfetto show.
//
// Off until Start; a span then costs one load of a flag. When on, it costs two clock reads and a handful of stores,
// takes no lock, and overwrites the oldest event once the ring is full.
//
//   void Build() {
//     TraceSpan span("terrain.build");
//     ...
//     TraceCounter("terrain.waiting", waiting);
//   }
//
// Names are string literals, "room.what": only the pointer is kept.
// Units: events carry microseconds since the machine's own clock began.
// Threads: any, also Write while others record: events that are being overwritten just then are left out.
#pragma once

#include "runtime/base/clock.h"
#include "runtime/base/status.h"

#include <atomic>
#include <cstddef>
#include <string>

namespace belvedere {

class Trace {
 public:
  // Switches recording on and forgets what was recorded. capacity: events that the ring holds, 64 bytes each; the first
  // call decides it for the whole run. REQUIRES: capacity > 0
  static void Start(size_t capacity);
  static void Stop();
  static bool on() { return on_.load(std::memory_order_acquire); }

  // What the written trace calls the calling thread; at most kMostNamedThreads are named.
  static void NameThread(const char* name);
  // Writes what the ring holds, oldest first, beside `path` and then moves it there.
  static Status Write(const std::string& path);

  static constexpr size_t kMostNamedThreads = 256;

 private:
  friend class TraceSpan;
  friend void TraceCounter(const char* name, double value);
  static void RecordSpan(const char* name, double start_s, double end_s);
  static void RecordCounter(const char* name, double value);

  static inline std::atomic<bool> on_{false};
};

// From its construction to its destruction.
class TraceSpan {
 public:
  explicit TraceSpan(const char* name) {
    if (!Trace::on()) return;
    name_ = name;
    start_s_ = Clock::System().NowSeconds();
  }
  ~TraceSpan() {
    if (name_ != nullptr) Trace::RecordSpan(name_, start_s_, Clock::System().NowSeconds());
  }
  TraceSpan(const TraceSpan&) = delete;
  TraceSpan& operator=(const TraceSpan&) = delete;

 private:
  const char* name_ = nullptr;
  double start_s_ = 0;
};

inline void TraceCounter(const char* name, double value) {
  if (Trace::on()) Trace::RecordCounter(name, value);
}

}  // namespace belvedere

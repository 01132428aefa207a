#include "runtime/base/trace.h"

#include "runtime/base/mutex.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory>
#include <vector>

namespace belvedere {
namespace {

constexpr double kCounterMark = -1;  // duration of an event that is a counter

struct Event {
  const char* name = nullptr;
  double start_s = 0;
  double duration_s = 0;  // kCounterMark: `value` counts
  double value = 0;
  uint32_t thread = 0;
};

// An event that one thread may overwrite while another reads it: the reader believes it when `ticket` stood still.
struct alignas(64) Slot {
  std::atomic<uint64_t> ticket{0};  // 0 while it is written, else 1 + number of the event
  std::atomic<const char*> name{nullptr};
  std::atomic<double> start_s{0};
  std::atomic<double> duration_s{0};
  std::atomic<double> value{0};
  std::atomic<uint32_t> thread{0};
};

class Ring {
 public:
  explicit Ring(size_t capacity) : slots_(capacity) {}

  void Clear() { first_.store(next_.load()); }

  void Record(const Event& event) {
    const uint64_t number = next_.fetch_add(1, std::memory_order_relaxed);
    Slot& slot = slots_[number % slots_.size()];
    slot.ticket.store(0, std::memory_order_release);
    slot.name.store(event.name, std::memory_order_release);
    slot.start_s.store(event.start_s, std::memory_order_release);
    slot.duration_s.store(event.duration_s, std::memory_order_release);
    slot.value.store(event.value, std::memory_order_release);
    slot.thread.store(event.thread, std::memory_order_release);
    slot.ticket.store(number + 1, std::memory_order_release);
  }

  std::vector<Event> Events() const {
    const uint64_t end = next_.load();
    const uint64_t oldest = end > slots_.size() ? end - slots_.size() : 0;
    std::vector<Event> events;
    for (uint64_t number = std::max(oldest, first_.load()); number < end; ++number) {
      const Slot& slot = slots_[number % slots_.size()];
      if (slot.ticket.load(std::memory_order_acquire) != number + 1) continue;
      const Event event{slot.name.load(std::memory_order_acquire), slot.start_s.load(std::memory_order_acquire),
                        slot.duration_s.load(std::memory_order_acquire), slot.value.load(std::memory_order_acquire),
                        slot.thread.load(std::memory_order_acquire)};
      if (slot.ticket.load(std::memory_order_acquire) == number + 1) events.push_back(event);
    }
    return events;
  }

 private:
  std::vector<Slot> slots_;
  std::atomic<uint64_t> next_{0};
  std::atomic<uint64_t> first_{0};
};

// Once made, the ring stays until the program ends, for a thread may be recording into it at any time.
std::atomic<Ring*> the_ring{nullptr};

struct NamedThread {
  uint32_t thread = 0;
  const char* name = nullptr;
};
struct ThreadNames {
  Mutex mutex;
  std::vector<NamedThread> names GUARDED_BY(mutex);
};
ThreadNames& Names() {
  static ThreadNames names;
  return names;
}

uint32_t ThisThread() {
  static std::atomic<uint32_t> threads{0};
  thread_local const uint32_t number = ++threads;
  return number;
}

std::string Quoted(const char* text) {
  std::string quoted = "\"";
  for (; *text != '\0'; ++text) {
    if (*text == '"' || *text == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(*text) < ' ' ? ' ' : *text;
  }
  return quoted + '"';
}

std::string ToJson(const Event& event) {
  constexpr double kMicroseconds = 1e6;
  if (event.duration_s == kCounterMark) {
    return fmt::format(R"({{"ph":"C","pid":1,"tid":{},"name":{},"ts":{:.3f},"args":{{"value":{}}}}})", event.thread,
                       Quoted(event.name), event.start_s * kMicroseconds, event.value);
  }
  return fmt::format(R"({{"ph":"X","pid":1,"tid":{},"name":{},"ts":{:.3f},"dur":{:.3f}}})", event.thread,
                     Quoted(event.name), event.start_s * kMicroseconds, event.duration_s * kMicroseconds);
}

std::string AllAsJson() {
  std::string json = R"({"displayTimeUnit":"ms","traceEvents":[)";
  const char* separator = "\n";
  {
    ThreadNames& names = Names();
    MutexLock lock(names.mutex);
    for (const NamedThread& named : names.names) {
      fmt::format_to(std::back_inserter(json),
                     R"({}{{"ph":"M","pid":1,"tid":{},"name":"thread_name","args":{{"name":{}}}}})", separator,
                     named.thread, Quoted(named.name));
      separator = ",\n";
    }
  }
  if (const Ring* ring = the_ring.load(std::memory_order_acquire); ring != nullptr) {
    for (const Event& event : ring->Events()) {
      json += separator;
      json += ToJson(event);
      separator = ",\n";
    }
  }
  return json + "\n]}\n";
}

}  // namespace

void Trace::Start(size_t capacity) {
  BELVEDERE_CHECK(capacity > 0);
  if (Ring* ring = the_ring.load(std::memory_order_acquire); ring != nullptr) {
    ring->Clear();
  } else {
    auto fresh = std::make_unique<Ring>(capacity);
    if (the_ring.compare_exchange_strong(ring, fresh.get(), std::memory_order_acq_rel))
      static_cast<void>(fresh.release());
  }
  on_.store(true, std::memory_order_release);
}

void Trace::Stop() {
  on_.store(false, std::memory_order_relaxed);
}

void Trace::NameThread(const char* name) {
  const uint32_t thread = ThisThread();
  ThreadNames& names = Names();
  MutexLock lock(names.mutex);
  for (NamedThread& named : names.names) {
    if (named.thread == thread) {
      named.name = name;
      return;
    }
  }
  if (names.names.size() < kMostNamedThreads) names.names.push_back({thread, name});
}

void Trace::RecordSpan(const char* name, double start_s, double end_s) {
  Ring* const ring = the_ring.load(std::memory_order_acquire);
  ring->Record({name, start_s, std::max(end_s - start_s, 0.0), 0, ThisThread()});
}

void Trace::RecordCounter(const char* name, double value) {
  Ring* const ring = the_ring.load(std::memory_order_acquire);
  ring->Record({name, Clock::System().NowSeconds(), kCounterMark, value, ThisThread()});
}

Status Trace::Write(const std::string& path) {
  const std::string partial = path + ".partial";
  const std::string json = AllAsJson();
  const auto failed = [&](const char* what) {
    return Status::Error("{}: cannot {} the trace: {}; choose another place", path, what, std::strerror(errno));
  };
  std::FILE* const file = std::fopen(partial.c_str(), "wb");
  if (file == nullptr) return failed("create");
  const bool written = std::fwrite(json.data(), 1, json.size(), file) == json.size();
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed || std::rename(partial.c_str(), path.c_str()) != 0) {
    const Status status = failed("write");
    std::remove(partial.c_str());
    return status;
  }
  return {};
}

}  // namespace belvedere

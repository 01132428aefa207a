// RequestQueue: what the managers want of one server, most wanted first.
//
// Each view states all its wishes at once, as often as it likes: SetWishes replaces what it said before. A page that
// several views want has the highest of their priorities. A wish that no view repeats is obsolete and is never served;
// one that is repeated with another priority rises or sinks. A page that a server has taken is not given out a second
// time before Done.
//
// Bounded: at most `capacity` pages wait; the least wanted are dropped (and counted), their views will wish again.
//
// Units: priority is a pure number, greater is sooner (managers use the error in pixels that the page would cure).
// Threads: any; Take blocks on a condition until there is a request or Stop was called.
#pragma once

#include "runtime/base/clock.h"
#include "runtime/base/mutex.h"
#include "runtime/base/view_id.h"
#include "runtime/paging/page.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace belvedere {

struct Wish {
  PageKey key;
  float priority = 0;
};

class RequestQueue {
 public:
  struct Statistics {
    uint64_t issued = 0;     // pages that entered the queue
    uint64_t served = 0;     // pages for which Done was called
    uint64_t cancelled = 0;  // pages that left the queue unserved: obsolete or dropped
    size_t waiting = 0;      // now
    size_t peak_waiting = 0;
    double p95_wait_ms = 0;  // from the first wish to Take, over the last 1024 pages taken
  };

  RequestQueue(size_t capacity, const Clock& clock);
  ~RequestQueue();
  RequestQueue(const RequestQueue&) = delete;
  RequestQueue& operator=(const RequestQueue&) = delete;

  // Replaces all wishes of that view. An empty span withdraws them (a closed view).
  void SetWishes(ViewId view, std::span<const Wish> wishes);

  // The most wanted page; nullopt once stopped.
  std::optional<PageKey> Take();
  // What Take would return if it need not wait.
  std::optional<PageKey> TryTake();
  // The page that was taken is resident or failed.
  void Done(const PageKey& key);

  // Wakes everybody who waits in Take, for good.
  void Stop();

  Statistics Stats() const;

 private:
  struct State;
  mutable Mutex mutex_;
  CondVar wanted_;
  const std::unique_ptr<State> state_ PT_GUARDED_BY(mutex_);
};

}  // namespace belvedere

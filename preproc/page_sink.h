// PageSink: the one thread that writes pages into the dataset, behind a bounded queue.
//
// Threads: Put, any; it waits while the queue is full. Close, one, after the last Put.
#pragma once

#include "runtime/base/mutex.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset_writer.h"

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace belvedere {

class PageSink {
 public:
  // batch_bytes: of a transaction. notes: what the writer keeps with each; asked for on the writing thread.
  PageSink(DatasetWriter& writer, int64_t batch_bytes, std::function<std::string()> notes);
  ~PageSink();

  // Pages come into the dataset in the order in which they are put. deviations: empty where none are kept.
  void Put(int layer, Quadcode node, std::vector<uint8_t> value, std::vector<uint8_t> deviations = {})
      EXCLUDES_LOCK(mutex_);
  // Nothing more will be written, for a reason that lies elsewhere.
  void Fail(Status status) EXCLUDES_LOCK(mutex_);
  // Waits until everything is written.
  Status Close() EXCLUDES_LOCK(mutex_);
  // Something could not be written: nothing more will be.
  bool failed() const { return failed_.load(std::memory_order_relaxed); }
  int64_t pages() const { return pages_.load(std::memory_order_relaxed); }
  int64_t bytes() const { return bytes_.load(std::memory_order_relaxed); }

 private:
  struct Item {
    int layer = 0;
    Quadcode node;
    std::vector<uint8_t> value, deviations;
  };
  void Run() EXCLUDES_LOCK(mutex_);
  Status Write(const Item& item);

  DatasetWriter& writer_;
  const int64_t batch_bytes_;
  const std::function<std::string()> notes_;
  int64_t uncommitted_bytes_ = 0;  // the writing thread's
  std::atomic<bool> failed_{false};
  std::atomic<int64_t> pages_{0}, bytes_{0};
  Mutex mutex_;
  CondVar changed_;
  std::deque<Item> queue_ GUARDED_BY(mutex_);
  bool closing_ GUARDED_BY(mutex_) = false;
  Status status_ GUARDED_BY(mutex_);
  std::thread thread_;  // last: starts when all else is there
};

}  // namespace belvedere

#include "preproc/page_sink.h"

#include <utility>

namespace belvedere {
namespace {

constexpr size_t kLongestQueue = 256;
constexpr int64_t kBatchBytes = int64_t{32} << 20;  // a transaction

}  // namespace

PageSink::PageSink(DatasetWriter& writer) : writer_(writer), thread_([this] { Run(); }) {}

PageSink::~PageSink() {
  static_cast<void>(Close().ok());
}

void PageSink::Put(int layer, Quadcode node, std::vector<uint8_t> value) {
  const MutexLock lock(mutex_);
  while (queue_.size() >= kLongestQueue && status_.ok()) changed_.Wait(mutex_);
  if (!status_.ok()) return;
  queue_.push_back({layer, node, std::move(value)});
  changed_.NotifyAll();
}

Status PageSink::Close() {
  {
    const MutexLock lock(mutex_);
    closing_ = true;
    changed_.NotifyAll();
  }
  if (thread_.joinable()) thread_.join();
  const MutexLock lock(mutex_);
  return status_;
}

void PageSink::Run() {
  for (;;) {
    Item item;
    {
      const MutexLock lock(mutex_);
      while (queue_.empty() && !closing_) changed_.Wait(mutex_);
      if (queue_.empty()) return;
      item = std::move(queue_.front());
      queue_.pop_front();
      changed_.NotifyAll();
    }
    if (Status status = Write(item); !status.ok()) {
      failed_.store(true, std::memory_order_relaxed);
      const MutexLock lock(mutex_);
      status_ = std::move(status);
      queue_.clear();
      changed_.NotifyAll();
      return;
    }
  }
}

Status PageSink::Write(const Item& item) {
  if (Status status = writer_.Put(item.layer, item.node, item.value); !status.ok()) return status;
  pages_.fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(static_cast<int64_t>(item.value.size()), std::memory_order_relaxed);
  uncommitted_bytes_ += static_cast<int64_t>(item.value.size());
  if (uncommitted_bytes_ < kBatchBytes) return {};
  uncommitted_bytes_ = 0;
  return writer_.Commit();
}

}  // namespace belvedere

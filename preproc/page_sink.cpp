#include "preproc/page_sink.h"

#include <utility>

namespace belvedere {
namespace {

constexpr size_t kLongestQueue = 256;

}  // namespace

PageSink::PageSink(DatasetWriter& writer, int64_t batch_bytes, std::function<std::string()> notes)
    : writer_(writer), batch_bytes_(batch_bytes), notes_(std::move(notes)), thread_([this] { Run(); }) {}

PageSink::~PageSink() {
  static_cast<void>(Close().ok());
}

void PageSink::Put(int layer, Quadcode node, std::vector<uint8_t> value, std::vector<uint8_t> deviations) {
  const MutexLock lock(mutex_);
  while (queue_.size() >= kLongestQueue && status_.ok()) changed_.Wait(mutex_);
  if (!status_.ok()) return;
  queue_.push_back({layer, node, std::move(value), std::move(deviations)});
  changed_.NotifyAll();
}

void PageSink::Fail(Status status) {
  failed_.store(true, std::memory_order_relaxed);
  const MutexLock lock(mutex_);
  if (status_.ok()) status_ = std::move(status);
  queue_.clear();
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
      Fail(std::move(status));
      return;
    }
  }
}

Status PageSink::Write(const Item& item) {
  if (!item.deviations.empty()) {
    if (Status status = writer_.PutDeviations(item.layer, item.node, item.deviations); !status.ok()) return status;
  }
  if (Status status = writer_.Put(item.layer, item.node, item.value); !status.ok()) return status;
  const auto bytes = static_cast<int64_t>(item.value.size() + item.deviations.size());
  pages_.fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(bytes, std::memory_order_relaxed);
  uncommitted_bytes_ += bytes;
  if (uncommitted_bytes_ < batch_bytes_) return {};
  uncommitted_bytes_ = 0;
  if (Status status = writer_.Note(notes_()); !status.ok()) return status;
  return writer_.Commit();
}

}  // namespace belvedere

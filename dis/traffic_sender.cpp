#include "dis/traffic_sender.h"

#include "runtime/base/log.h"

#include <utility>

namespace belvedere::dis {

Result<std::unique_ptr<TrafficSender>> TrafficSender::Start(const TrafficSenderOptions& options, const Clock& clock) {
  TrafficOptions traffic = options.traffic;
  if (traffic.utc_at_start_s >= 0) traffic.utc_at_start_s = clock.UtcSeconds();
  auto stream = TrafficStream::Make(traffic);
  if (!stream.ok()) return stream.status();
  auto sender = UdpSender::Open(options.to, options.interface_address);
  if (!sender.ok()) return sender.status();
  return std::unique_ptr<TrafficSender>(new TrafficSender(std::move(*stream), std::move(*sender), clock));
}

TrafficSender::TrafficSender(TrafficStream stream, std::unique_ptr<UdpSender> sender, const Clock& clock)
    : clock_(clock), start_s_(clock.NowSeconds()), stream_(std::move(stream)), sender_(std::move(sender)) {
  thread_ = std::thread([this] { Run(); });
}

TrafficSender::~TrafficSender() {
  Stop();
}

void TrafficSender::Stop() {
  {
    MutexLock lock(mutex_);
    stop_ = true;
  }
  wake_.NotifyAll();
  if (thread_.joinable()) thread_.join();
}

Status TrafficSender::status() const {
  MutexLock lock(mutex_);
  return status_;
}

void TrafficSender::Run() {
  while (WaitUntil(start_s_ + stream_.NextStep())) {
    const std::span<const uint8_t> due = stream_.Advance(clock_.NowSeconds() - start_s_);
    Status status = sender_->SendMany(due, kEntityStateBytes);
    sent_ += due.size() / kEntityStateBytes;
    for (const std::vector<uint8_t>& datagram : stream_.Engagements()) {
      if (status.ok()) status = sender_->Send(datagram);
      ++sent_;
    }
    if (status.ok()) continue;
    LogError("traffic stops: {}", status.message());
    MutexLock lock(mutex_);
    status_ = std::move(status);
    return;
  }
}

bool TrafficSender::WaitUntil(double time_s) {
  MutexLock lock(mutex_);
  while (!stop_) {
    const double left_s = time_s - clock_.NowSeconds();
    if (left_s <= 0) return true;
    wake_.WaitFor(mutex_, std::chrono::ceil<std::chrono::microseconds>(std::chrono::duration<double>(left_s)));
  }
  return false;
}

}  // namespace belvedere::dis

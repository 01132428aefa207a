// TrafficSender: sends a TrafficStream in real time, on a thread of its own.
//
// Threads: Stop and the counts from any thread.
#pragma once

#include "dis/endpoint.h"
#include "dis/traffic_stream.h"
#include "dis/udp_sender.h"
#include "runtime/base/clock.h"
#include "runtime/base/mutex.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

namespace belvedere::dis {

struct TrafficSenderOptions {
  Endpoint to{"127.0.0.1", 3000};
  std::string interface_address{};  // for multicast; empty: the default
  TrafficOptions traffic{};
};

class TrafficSender {
 public:
  // Timestamps are absolute when traffic.utc_at_start_s is not negative; its value is then the start's. The clock must
  // outlive the sender.
  static Result<std::unique_ptr<TrafficSender>> Start(const TrafficSenderOptions& options, const Clock& clock);
  ~TrafficSender();  // stops
  TrafficSender(const TrafficSender&) = delete;
  TrafficSender& operator=(const TrafficSender&) = delete;

  void Stop();
  uint64_t sent() const { return sent_.load(); }
  // Ok unless sending had to be given up, as when the network went away.
  Status status() const;

 private:
  TrafficSender(TrafficStream stream, std::unique_ptr<UdpSender> sender, const Clock& clock);
  void Run();
  bool WaitUntil(double time_s) EXCLUDES_LOCK(mutex_);  // false: stop

  const Clock& clock_;
  const double start_s_;
  TrafficStream stream_;  // the thread's
  std::unique_ptr<UdpSender> sender_;
  std::atomic<uint64_t> sent_ = 0;
  mutable Mutex mutex_;
  CondVar wake_;
  bool stop_ GUARDED_BY(mutex_) = false;
  Status status_ GUARDED_BY(mutex_);
  std::thread thread_;
};

}  // namespace belvedere::dis

#include "dis/receiver.h"

#include "runtime/base/mutex.h"

#include <utility>

namespace belvedere::dis {

class Receiver::Sink final : public DatagramSink {
 public:
  Sink(ObjectTable& table, IntakeOptions options) : table_(table), intake_(table, std::move(options)) {}

  void TakeBatch(std::span<const Datagram> batch, double now_s, double utc_s) override {
    for (const Datagram& datagram : batch) intake_.Take(datagram.bytes, {now_s, utc_s, datagram.from});
    MutexLock lock(mutex_);
    counters_ = intake_.counters();
  }

  std::optional<double> Settle(double now_s) override {
    table_.Tick(now_s);
    return table_.NextTick();
  }

  IntakeCounters Counters() const {
    MutexLock lock(mutex_);
    return counters_;
  }

 private:
  ObjectTable& table_;
  Intake intake_;  // the listener's thread only
  mutable Mutex mutex_;
  IntakeCounters counters_ GUARDED_BY(mutex_);
};

Receiver::Receiver(const ReceiverOptions& options, ObjectTable& table)
    : table_(table), sink_(std::make_unique<Sink>(table, options.intake)) {}

Receiver::~Receiver() {
  Stop();
}

Result<std::unique_ptr<Receiver>> Receiver::Start(const ReceiverOptions& options, ObjectTable& table,
                                                  const Clock& clock) {
  std::unique_ptr<Receiver> receiver(new Receiver(options, table));
  auto listener = UdpListener::Start(options.network, *receiver->sink_, clock);
  if (!listener.ok()) return listener.status();
  receiver->listener_ = std::move(*listener);
  return receiver;
}

void Receiver::Stop() {
  if (listener_) listener_->Stop();
}

ReceiverCounters Receiver::Counters() const {
  return {sink_->Counters(), table_.Counters(), listener_->LostByKernel(), listener_->receive_buffer_bytes()};
}

}  // namespace belvedere::dis

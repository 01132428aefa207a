#include "dis/recorder.h"

#include <arpa/inet.h>

#include <atomic>
#include <utility>

namespace belvedere::dis {
namespace {

// What the listener was bound to, in the family of a datagram's sender.
UdpAddress Target(const Endpoint& listen, bool v6) {
  UdpAddress address;
  address.v6 = v6;
  address.port = listen.port;
  const std::string numeric = listen.address.substr(0, listen.address.find('%'));
  // An address of the other family stays all zeros, "any".
  inet_pton(v6 ? AF_INET6 : AF_INET, numeric.c_str(), address.bytes.data());
  return address;
}

}  // namespace

class Recorder::Sink final : public DatagramSink {
 public:
  Sink(PcapWriter writer, const Endpoint& listen)
      : writer_(std::move(writer)), to_v4_(Target(listen, false)), to_v6_(Target(listen, true)) {}

  void TakeBatch(std::span<const Datagram> batch, double, double utc_s) override {
    for (const Datagram& datagram : batch) {
      writer_.Write(datagram.bytes, datagram.from, datagram.from.v6 ? to_v6_ : to_v4_, utc_s);
    }
    datagrams_ += batch.size();
  }
  std::optional<double> Settle(double) override { return std::nullopt; }

  // REQUIRES: the listener has stopped.
  Status Finish() { return writer_.Finish(); }
  uint64_t datagrams() const { return datagrams_.load(); }

 private:
  PcapWriter writer_;
  const UdpAddress to_v4_, to_v6_;
  std::atomic<uint64_t> datagrams_ = 0;
};

Recorder::Recorder(std::unique_ptr<Sink> sink) : sink_(std::move(sink)) {}

Recorder::~Recorder() {
  if (listener_) listener_->Stop();
}

Result<std::unique_ptr<Recorder>> Recorder::Start(const ListenOptions& options, const std::filesystem::path& path,
                                                  const Clock& clock) {
  auto writer = PcapWriter::Create(path);
  if (!writer.ok()) return writer.status();
  std::unique_ptr<Recorder> recorder(new Recorder(std::make_unique<Sink>(std::move(*writer), options.listen)));
  auto listener = UdpListener::Start(options, *recorder->sink_, clock);
  if (!listener.ok()) return listener.status();
  recorder->listener_ = std::move(*listener);
  return recorder;
}

uint64_t Recorder::datagrams() const {
  return sink_->datagrams();
}

Status Recorder::Finish() {
  listener_->Stop();
  return sink_->Finish();
}

}  // namespace belvedere::dis

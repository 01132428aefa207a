// UdpListener: a bound UDP socket and the thread that hands its datagrams to a sink.
//
// The address may be one of this machine's, any (0.0.0.0, or [::] for IPv6 and IPv4 together), a broadcast address, or
// a multicast group, which is joined. Datagrams are taken from the kernel in batches, so that thousands a second cost
// little. The thread sleeps in the kernel until a datagram, the sink's next due time or Stop; it never polls.
//
// Units:   seconds of the injected clock.
// Threads: the sink is called by the listener's thread only, between Start and the end of Stop.
#pragma once

#include "dis/endpoint.h"
#include "dis/udp_address.h"
#include "runtime/base/clock.h"
#include "runtime/base/status.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace belvedere::dis {

struct Datagram {
  std::span<const uint8_t> bytes;  // valid during the call only
  UdpAddress from;
  bool cut_short = false;  // longer than any UDP datagram may be
};

class DatagramSink {
 public:
  virtual ~DatagramSink() = default;
  // A batch that was waiting at now_s.
  virtual void TakeBatch(std::span<const Datagram> batch, double now_s, double utc_s) = 0;
  // After all that were waiting have been taken, and when the time it last gave has come. Returns when to be called
  // again though nothing arrives; nullopt: never.
  virtual std::optional<double> Settle(double now_s) = 0;
};

struct ListenOptions {
  Endpoint listen{"0.0.0.0", 3000};
  std::string interface_address{};     // IPv4 address of the interface that joins a multicast group; empty: the default
  int receive_buffer_bytes = 8 << 20;  // asked of the kernel; Start warns when it gives much less
};

class UdpListener {
 public:
  // The sink and the clock must outlive the listener.
  static Result<std::unique_ptr<UdpListener>> Start(const ListenOptions& options, DatagramSink& sink,
                                                    const Clock& clock);
  virtual ~UdpListener() = default;  // stops

  virtual void Stop() = 0;
  // Datagrams that arrived and were dropped because the receive buffer was full; exact at any time.
  virtual uint64_t LostByKernel() const = 0;
  virtual int receive_buffer_bytes() const = 0;
};

}  // namespace belvedere::dis

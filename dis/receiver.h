// Receiver: DIS from the network into the object table, on a thread of its own.
//
// Units:   seconds of the injected clock, which the table's readers must use too.
// Threads: Counters, Stop from any thread.
#pragma once

#include "dis/intake.h"
#include "dis/udp_listener.h"

#include <memory>

namespace belvedere::dis {

struct ReceiverOptions {
  ListenOptions network{};
  IntakeOptions intake{};
};

struct ReceiverCounters {
  IntakeCounters intake;
  ObjectTableCounters objects;
  uint64_t lost_by_kernel = 0;
  int receive_buffer_bytes = 0;
};

class Receiver {
 public:
  // One line says why not: the port is in use, the address is not this machine's, ... The table and the clock must
  // outlive the receiver.
  static Result<std::unique_ptr<Receiver>> Start(const ReceiverOptions& options, ObjectTable& table,
                                                 const Clock& clock);
  ~Receiver();  // stops
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  void Stop();
  ReceiverCounters Counters() const;

 private:
  class Sink;
  Receiver(const ReceiverOptions& options, ObjectTable& table);

  ObjectTable& table_;
  std::unique_ptr<Sink> sink_;
  std::unique_ptr<UdpListener> listener_;
};

}  // namespace belvedere::dis

// Recorder: datagrams from the network into a capture file.
//
// Threads: Finish and the count from any thread.
#pragma once

#include "dis/pcap.h"
#include "dis/udp_listener.h"

#include <memory>

namespace belvedere::dis {

class Recorder {
 public:
  static Result<std::unique_ptr<Recorder>> Start(const ListenOptions& options, const std::filesystem::path& path,
                                                 const Clock& clock);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  uint64_t datagrams() const;
  uint64_t LostByKernel() const { return listener_->LostByKernel(); }
  // Stops, and moves the file into its place.
  Status Finish();

 private:
  class Sink;
  explicit Recorder(std::unique_ptr<Sink> sink);

  std::unique_ptr<Sink> sink_;
  std::unique_ptr<UdpListener> listener_;
};

}  // namespace belvedere::dis

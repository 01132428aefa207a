// UdpSender: sends datagrams to one endpoint, unicast, broadcast or multicast, many with one call.
//
// Threads: belongs to its user.
#pragma once

#include "dis/endpoint.h"
#include "runtime/base/status.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace belvedere::dis {

class UdpSender {
 public:
  // interface_address: IPv4 address of the interface that multicast leaves by; empty: the default.
  static Result<std::unique_ptr<UdpSender>> Open(const Endpoint& to, const std::string& interface_address = {});
  virtual ~UdpSender() = default;

  // Waits where the kernel's send buffer is full. A datagram that nobody listens for is no error.
  virtual Status Send(std::span<const uint8_t> datagram) = 0;
  // `bytes` holds datagrams of `length` bytes each.
  virtual Status SendMany(std::span<const uint8_t> bytes, size_t length) = 0;
};

}  // namespace belvedere::dis

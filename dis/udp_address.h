// UdpAddress: where a datagram came from; AddressRange: which addresses a user means.
//
// Threads: values.
#pragma once

#include "runtime/base/status.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere::dis {

// A numeric address and port as IP carries them; IPv4 in the first four bytes.
struct UdpAddress {
  std::array<uint8_t, 16> bytes{};
  uint16_t port = 0;
  bool v6 = false;
  // A number for the host, whatever the port; never 0.
  uint64_t host() const;
};

// "10.0.0.0/8", "192.0.2.7", "fe80::/10". An IPv4 range holds IPv4 addresses that came over IPv6 (::ffff:10.0.0.1) too.
class AddressRange {
 public:
  static Result<AddressRange> Parse(std::string_view text);
  bool Contains(const UdpAddress& address) const;

 private:
  std::array<uint8_t, 16> bytes_{};
  int bits_ = 0;  // of the prefix
  bool v6_ = false;
};

// Of a list as users write it; the error names the entry that is wrong.
Result<std::vector<AddressRange>> ParseAddressRanges(std::span<const std::string> texts);
bool AnyContains(std::span<const AddressRange> ranges, const UdpAddress& address);

}  // namespace belvedere::dis

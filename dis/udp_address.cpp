#include "dis/udp_address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstring>

namespace belvedere::dis {
namespace {

constexpr std::array<uint8_t, 12> kMappedPrefix = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};

// The IPv4 address that came over IPv6, as the IPv4 address that it is.
UdpAddress Unmapped(const UdpAddress& address) {
  if (!address.v6 || !std::equal(kMappedPrefix.begin(), kMappedPrefix.end(), address.bytes.begin())) return address;
  UdpAddress v4;
  std::copy(address.bytes.begin() + kMappedPrefix.size(), address.bytes.end(), v4.bytes.begin());
  v4.port = address.port;
  return v4;
}

}  // namespace

uint64_t UdpAddress::host() const {
  const UdpAddress plain = Unmapped(*this);
  uint64_t hash = plain.v6 ? 0xCBF29CE484222325u : 0x84222325CBF29CE4u;
  for (const uint8_t byte : plain.bytes) hash = (hash ^ byte) * 0x100000001B3u;  // FNV-1a
  return hash == 0 ? 1 : hash;
}

Result<AddressRange> AddressRange::Parse(std::string_view text) {
  AddressRange range;
  const size_t slash = text.find('/');
  const std::string address(text.substr(0, slash));
  range.v6_ = address.find(':') != std::string::npos;
  const int most = range.v6_ ? 128 : 32;
  const bool numeric = inet_pton(range.v6_ ? AF_INET6 : AF_INET, address.c_str(), range.bytes_.data()) == 1;
  range.bits_ = most;
  bool good = numeric;
  if (slash != std::string_view::npos) {
    const std::string_view bits = text.substr(slash + 1);
    const auto parsed = std::from_chars(bits.data(), bits.data() + bits.size(), range.bits_);
    good = good && parsed.ec == std::errc() && parsed.ptr == bits.data() + bits.size() && range.bits_ >= 0 &&
           range.bits_ <= most;
  }
  if (!good)
    return Status::Error("\"{}\" is no address or range; write \"10.0.0.0/8\", \"192.0.2.7\", \"fe80::/10\"", text);
  return range;
}

bool AddressRange::Contains(const UdpAddress& address) const {
  const UdpAddress plain = v6_ ? address : Unmapped(address);
  if (plain.v6 != v6_) return false;
  const auto whole = static_cast<size_t>(bits_ / 8);
  if (!std::equal(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(whole), plain.bytes.begin()))
    return false;
  const int rest = bits_ % 8;
  if (rest == 0) return true;
  const int shift = 8 - rest;
  return bytes_[whole] >> shift == plain.bytes[whole] >> shift;
}

Result<std::vector<AddressRange>> ParseAddressRanges(std::span<const std::string> texts) {
  std::vector<AddressRange> ranges;
  ranges.reserve(texts.size());
  for (const std::string& text : texts) {
    const Result<AddressRange> range = AddressRange::Parse(text);
    if (!range.ok()) return range.status();
    ranges.push_back(*range);
  }
  return ranges;
}

bool AnyContains(std::span<const AddressRange> ranges, const UdpAddress& address) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const AddressRange& range) { return range.Contains(address); });
}

}  // namespace belvedere::dis

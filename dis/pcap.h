// Capture files of the classic pcap format: the UDP datagrams in them, and new ones.
//
// Read are both byte orders and both resolutions of time; Ethernet (with VLAN tags), raw IP, BSD loopback and both
// Linux cooked link types; IPv4 and IPv6. Frames that hold no whole UDP datagram (other protocols, fragments, cut
// short) are counted and stepped over. Written is raw IP (link type 101), with the header that the datagram came with.
//
// Units:   seconds since 1970-01-01 UTC.
// Threads: each reader and writer belongs to its user.
#pragma once

#include "dis/udp_listener.h"
#include "runtime/base/status.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <vector>

namespace belvedere::dis {

// What a frame of that link type carries; nullopt when that is not one whole UDP datagram. Pure.
std::optional<std::span<const uint8_t>> UdpPayload(std::span<const uint8_t> frame, uint32_t link_type);

struct CapturedDatagram {
  uint64_t frame = 0;  // counts the frames of the file from 1
  double utc_s = 0;
  std::span<const uint8_t> bytes;  // valid until the next call
};

class PcapReader {
 public:
  // A file that is no capture is taken as one raw datagram, frame 1.
  static Result<PcapReader> Open(const std::filesystem::path& path);
  // nullopt at the end, or where the file is damaged; status() tells.
  std::optional<CapturedDatagram> Next();
  const Status& status() const { return status_; }
  uint64_t stepped_over() const { return stepped_over_; }

 private:
  uint32_t Word(std::span<const uint8_t> bytes, size_t at) const;
  bool NextFrame(CapturedDatagram& frame);

  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<uint8_t> frame_;
  bool raw_ = false;
  bool big_endian_ = false;
  double fraction_s_ = 1e-6;
  uint32_t link_type_ = 0;
  uint64_t frames_ = 0;
  uint64_t stepped_over_ = 0;
  Status status_;
};

class PcapWriter {
 public:
  // Writes beside `path`; Finish moves the file into its place.
  static Result<PcapWriter> Create(const std::filesystem::path& path);
  // `to` is where the datagram went; IPv4 and IPv6 are written as `from` says.
  void Write(std::span<const uint8_t> datagram, const UdpAddress& from, const UdpAddress& to, double utc_s);
  Status Finish();

 private:
  std::filesystem::path path_, partial_;
  std::ofstream file_;
  std::vector<uint8_t> packet_;
};

}  // namespace belvedere::dis

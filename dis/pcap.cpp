#include "dis/pcap.h"

#include "dis/wire.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>

namespace belvedere::dis {
namespace {

constexpr uint32_t kMagicMicro = 0xA1B2C3D4, kMagicNano = 0xA1B23C4D, kMagicPcapng = 0x0A0D0D0A;
constexpr size_t kFileHeaderBytes = 24, kFrameHeaderBytes = 16;
constexpr size_t kLongestFrame = 262144;
constexpr uint16_t kEtherIpv4 = 0x0800, kEtherIpv6 = 0x86DD, kEtherVlan = 0x8100, kEtherVlanOuter = 0x88A8;
constexpr uint8_t kUdp = 17;
constexpr size_t kUdpHeaderBytes = 8;
constexpr uint32_t kLinkRaw = 101;

using Bytes = std::span<const uint8_t>;

uint16_t Word16(Bytes bytes, size_t at) {
  return static_cast<uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

// The IP packet in a frame of that link type.
std::optional<Bytes> IpPacket(Bytes frame, uint32_t link_type) {
  constexpr uint32_t kNull = 0, kEthernet = 1, kRaw12 = 12, kRaw14 = 14, kCooked = 113, kIpv4 = 228, kIpv6 = 229,
                     kCooked2 = 276;
  const auto after = [&](size_t header) -> std::optional<Bytes> {
    return frame.size() >= header ? std::optional(frame.subspan(header)) : std::nullopt;
  };
  switch (link_type) {
    case kNull: return after(4);
    case kRaw12:
    case kRaw14:
    case kLinkRaw:
    case kIpv4:
    case kIpv6: return frame;
    case kCooked: return after(16);
    case kCooked2: return after(20);
    case kEthernet: break;
    default: return std::nullopt;
  }
  size_t at = 12;  // of the Ethernet type
  while (frame.size() >= at + 2) {
    const uint16_t type = Word16(frame, at);
    at += 2;
    if (type == kEtherIpv4 || type == kEtherIpv6) return frame.subspan(at);
    if (type != kEtherVlan && type != kEtherVlanOuter) return std::nullopt;
    at += 2;
  }
  return std::nullopt;
}

// What an IPv4 packet carries, if that is UDP and whole.
std::optional<Bytes> UdpInIpv4(Bytes packet) {
  if (packet.size() < 20) return std::nullopt;
  const size_t header = size_t{4} * (packet[0] & 15), total = Word16(packet, 2);
  const bool fragment = (Word16(packet, 6) & 0x3FFF) != 0;
  if (header < 20 || total < header || total > packet.size() || fragment || packet[9] != kUdp) return std::nullopt;
  return packet.subspan(header, total - header);
}

std::optional<Bytes> UdpInIpv6(Bytes packet) {
  constexpr uint8_t kHopByHop = 0, kRouting = 43, kDestination = 60;
  if (packet.size() < 40 || size_t{40} + Word16(packet, 4) > packet.size()) return std::nullopt;
  Bytes rest = packet.subspan(40, Word16(packet, 4));
  uint8_t next = packet[6];
  while (next == kHopByHop || next == kRouting || next == kDestination) {
    if (rest.size() < 8) return std::nullopt;
    const size_t header = size_t{8} * (rest[1] + size_t{1});
    if (header > rest.size()) return std::nullopt;
    next = rest[0];
    rest = rest.subspan(header);
  }
  return next == kUdp ? std::optional(rest) : std::nullopt;
}

// The Internet checksum (RFC 1071) over more bytes of a sum.
uint32_t AddToSum(uint32_t sum, Bytes bytes) {
  for (size_t i = 0; i < bytes.size(); ++i) sum += i % 2 == 0 ? uint32_t{bytes[i]} << 8 : bytes[i];
  return sum;
}
uint16_t Folded(uint32_t sum) {
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<uint16_t>(~sum);
}

void WriteLittle(std::ostream& out, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.put(static_cast<char>(value >> shift & 0xFF));
}

// IP and UDP headers and the datagram, into `packet`.
void BuildPacket(Bytes datagram, const UdpAddress& from, const UdpAddress& to, std::vector<uint8_t>& packet) {
  const size_t ip_bytes = from.v6 ? 40 : 20, address_bytes = from.v6 ? 16 : 4;
  const size_t udp_bytes = kUdpHeaderBytes + datagram.size();
  packet.assign(ip_bytes + udp_bytes, 0);
  const std::span<uint8_t> bytes(packet);
  const Bytes source(from.bytes.data(), address_bytes), target(to.bytes.data(), address_bytes);
  WireWriter ip(bytes.first(ip_bytes));
  if (from.v6) {
    ip(uint32_t{0x60000000}, static_cast<uint16_t>(udp_bytes), kUdp, uint8_t{64});
  } else {
    ip(uint16_t{0x4500}, static_cast<uint16_t>(ip_bytes + udp_bytes), uint32_t{0}, uint8_t{64}, kUdp, uint16_t{0});
  }
  ip.Bytes(source);
  ip.Bytes(target);
  if (!from.v6) WireWriter(bytes.subspan(10, 2))(Folded(AddToSum(0, bytes.first(ip_bytes))));
  WireWriter udp(bytes.subspan(ip_bytes));
  udp(from.port, to.port, static_cast<uint16_t>(udp_bytes), uint16_t{0});
  udp.Bytes(datagram);
  uint32_t sum = AddToSum(AddToSum(kUdp, source), target) + static_cast<uint32_t>(udp_bytes);
  sum = AddToSum(sum, bytes.subspan(ip_bytes));
  const uint16_t checksum = Folded(sum);
  WireWriter(bytes.subspan(ip_bytes + 6, 2))(checksum == 0 ? uint16_t{0xFFFF} : checksum);
}

}  // namespace

std::optional<std::span<const uint8_t>> UdpPayload(Bytes frame, uint32_t link_type) {
  const std::optional<Bytes> packet = IpPacket(frame, link_type);
  if (!packet || packet->empty()) return std::nullopt;
  const int version = (*packet)[0] >> 4;
  const std::optional<Bytes> udp = version == 4 ? UdpInIpv4(*packet) : version == 6 ? UdpInIpv6(*packet) : std::nullopt;
  if (!udp || udp->size() < kUdpHeaderBytes) return std::nullopt;
  const size_t length = Word16(*udp, 4);
  if (length < kUdpHeaderBytes || length > udp->size()) return std::nullopt;
  return udp->subspan(kUdpHeaderBytes, length - kUdpHeaderBytes);
}

uint32_t PcapReader::Word(Bytes bytes, size_t at) const {
  const uint32_t big = WireReader(bytes, at).Next<uint32_t>();
  return big_endian_ ? big : (big << 24 | (big & 0xFF00) << 8 | (big >> 8 & 0xFF00) | big >> 24);
}

Result<PcapReader> PcapReader::Open(const std::filesystem::path& path) {
  PcapReader reader;
  reader.path_ = path;
  reader.file_.open(path, std::ios::binary);
  if (!reader.file_ || std::filesystem::is_directory(path)) {
    return Status::Error("{}: cannot open: {}", path.string(), reader.file_ ? "it is a folder" : std::strerror(errno));
  }
  std::array<uint8_t, kFileHeaderBytes> header{};
  reader.file_.read(reinterpret_cast<char*>(header.data()), kFileHeaderBytes);
  const auto got = static_cast<size_t>(reader.file_.gcount());
  const uint32_t first = WireReader(header).Next<uint32_t>();
  if (got >= 4 && first == kMagicPcapng) {
    return Status::Error("{}: this is a pcapng file; convert it with 'editcap -F pcap'", path.string());
  }
  for (const bool big : {false, true}) {
    reader.big_endian_ = big;
    const uint32_t magic = reader.Word(header, 0);
    if (got < kFileHeaderBytes || (magic != kMagicMicro && magic != kMagicNano)) continue;
    reader.fraction_s_ = magic == kMagicNano ? 1e-9 : 1e-6;
    reader.link_type_ = reader.Word(header, 20) & 0xFFFF;
    return reader;
  }
  reader.raw_ = true;
  const uintmax_t size = std::filesystem::file_size(path);
  if (size > 65535) {
    return Status::Error("{}: neither a pcap file nor one datagram (it has {} bytes)", path.string(), size);
  }
  reader.frame_.resize(size);
  reader.file_.clear();
  reader.file_.seekg(0);
  reader.file_.read(reinterpret_cast<char*>(reader.frame_.data()), static_cast<std::streamsize>(size));
  return reader;
}

std::optional<CapturedDatagram> PcapReader::Next() {
  CapturedDatagram datagram;
  if (raw_) {
    if (frames_++ > 0) return std::nullopt;
    datagram.frame = 1;
    datagram.bytes = frame_;
    return datagram;
  }
  while (NextFrame(datagram)) {
    const auto payload = UdpPayload(frame_, link_type_);
    if (payload) {
      datagram.bytes = *payload;
      return datagram;
    }
    ++stepped_over_;
  }
  return std::nullopt;
}

bool PcapReader::NextFrame(CapturedDatagram& frame) {
  std::array<uint8_t, kFrameHeaderBytes> header{};
  file_.read(reinterpret_cast<char*>(header.data()), kFrameHeaderBytes);
  if (file_.gcount() == 0) return false;
  const size_t length = Word(header, 8);
  frame.frame = ++frames_;
  frame.utc_s = Word(header, 0) + fraction_s_ * Word(header, 4);
  if (static_cast<size_t>(file_.gcount()) < kFrameHeaderBytes || length > kLongestFrame) {
    status_ = Status::Error("{}: frame {} is damaged; what comes before it was read", path_.string(), frames_);
    return false;
  }
  frame_.resize(length);
  file_.read(reinterpret_cast<char*>(frame_.data()), static_cast<std::streamsize>(length));
  if (static_cast<size_t>(file_.gcount()) == length) return true;
  status_ = Status::Error("{}: ends within frame {}; what comes before it was read", path_.string(), frames_);
  return false;
}

Result<PcapWriter> PcapWriter::Create(const std::filesystem::path& path) {
  PcapWriter writer;
  writer.path_ = path;
  writer.partial_ = path.string() + ".partial";
  writer.file_.open(writer.partial_, std::ios::binary | std::ios::trunc);
  if (!writer.file_) return Status::Error("{}: cannot write: {}", writer.partial_.string(), std::strerror(errno));
  WriteLittle(writer.file_, kMagicMicro);
  WriteLittle(writer.file_, 2 | 4 << 16);  // version 2.4
  WriteLittle(writer.file_, 0);
  WriteLittle(writer.file_, 0);
  WriteLittle(writer.file_, kLongestFrame);
  WriteLittle(writer.file_, kLinkRaw);
  return writer;
}

void PcapWriter::Write(Bytes datagram, const UdpAddress& from, const UdpAddress& to, double utc_s) {
  BuildPacket(datagram, from, to, packet_);
  const auto micros = static_cast<uint64_t>(std::llround(std::max(utc_s, 0.0) * 1e6));
  WriteLittle(file_, static_cast<uint32_t>(micros / 1'000'000));
  WriteLittle(file_, static_cast<uint32_t>(micros % 1'000'000));
  WriteLittle(file_, static_cast<uint32_t>(packet_.size()));
  WriteLittle(file_, static_cast<uint32_t>(packet_.size()));
  file_.write(reinterpret_cast<const char*>(packet_.data()), static_cast<std::streamsize>(packet_.size()));
}

Status PcapWriter::Finish() {
  file_.close();
  if (!file_) return Status::Error("{}: cannot write all of it; is the disk full?", partial_.string());
  std::error_code error;
  std::filesystem::rename(partial_, path_, error);
  if (error) return Status::Error("{}: cannot move it into place: {}", path_.string(), error.message());
  return {};
}

}  // namespace belvedere::dis

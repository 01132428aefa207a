#include "dis/pcap.h"

#include "dis/recorder.h"
#include "dis/udp_sender.h"
#include "tests/dis/fixtures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <string>
#include <thread>

namespace belvedere::dis {
namespace {

using Bytes = std::vector<uint8_t>;

// A file that is gone with the test.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("belvedere-" + std::to_string(getpid()) + "-" + name)) {}
  ~ScratchFile() {
    std::filesystem::remove(path_);
    std::filesystem::remove(path_.string() + ".partial");
  }
  const std::filesystem::path& path() const { return path_; }
  void Write(const Bytes& bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  Bytes Read() const {
    std::ifstream file(path_, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    return {text.begin(), text.end()};
  }

 private:
  std::filesystem::path path_;
};

UdpAddress Address(std::initializer_list<uint8_t> bytes, uint16_t port) {
  UdpAddress address;
  std::ranges::copy(bytes, address.bytes.begin());
  address.port = port;
  address.v6 = bytes.size() == 16;
  return address;
}

const UdpAddress kFrom = Address({10, 0, 0, 1}, 3000), kTo = Address({10, 0, 0, 255}, 3001);

Bytes Captured(const std::vector<Bytes>& datagrams) {
  const ScratchFile file("made.pcap");
  auto writer = PcapWriter::Create(file.path());
  double utc_s = 1.7e9;
  for (const Bytes& datagram : datagrams) writer->Write(datagram, kFrom, kTo, utc_s += 0.25);
  EXPECT_TRUE(writer->Finish().ok());
  return file.Read();
}

TEST(Pcap, WhatIsWrittenIsReadAgain) {
  const ScratchFile file("written.pcap");
  auto writer = PcapWriter::Create(file.path());
  ASSERT_TRUE(writer.ok()) << writer.message();
  const Bytes odd = {1, 2, 3};
  writer->Write(odd, kFrom, kTo, 1700000000.25);
  writer->Write({}, kFrom, kTo, 1700000000.5);
  const UdpAddress v6 = Address({0xFD, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, 3000);
  writer->Write(Encoded(SomeEntity()), v6, v6, 1700000001.0);
  EXPECT_FALSE(std::filesystem::exists(file.path()));  // not before it is whole
  ASSERT_TRUE(writer->Finish().ok());
  auto reader = PcapReader::Open(file.path());
  ASSERT_TRUE(reader.ok()) << reader.message();
  auto datagram = reader->Next();
  ASSERT_TRUE(datagram);
  EXPECT_EQ(datagram->frame, 1u);
  EXPECT_DOUBLE_EQ(datagram->utc_s, 1700000000.25);
  EXPECT_TRUE(std::ranges::equal(datagram->bytes, odd));
  datagram = reader->Next();
  ASSERT_TRUE(datagram);
  EXPECT_TRUE(datagram->bytes.empty());
  datagram = reader->Next();
  ASSERT_TRUE(datagram);
  EXPECT_TRUE(std::ranges::equal(datagram->bytes, Encoded(SomeEntity())));
  EXPECT_FALSE(reader->Next());
  EXPECT_TRUE(reader->status().ok());
}

TEST(Pcap, BytesOfTheFormat) {
  const Bytes file = Captured({{0xAB, 0xCD}});
  const Bytes head(file.begin(), file.begin() + 24);
  EXPECT_EQ(head, (Bytes{0xD4, 0xC3, 0xB2, 0xA1, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 101, 0, 0, 0}));
  const Bytes packet(file.begin() + 40, file.end());
  const Bytes expected = {0x45, 0,  0, 30, 0,   0,    0,    0,    64,   17, 0x65, 0xD0, 10, 0,    0,
                          1,    10, 0, 0,  255, 0x0B, 0xB8, 0x0B, 0xB9, 0,  10,   0,    0,  0xAB, 0xCD};
  ASSERT_EQ(packet.size(), expected.size());
  for (size_t i = 0; i < packet.size(); ++i) {
    const bool checksum = i == 10 || i == 11 || i == 26 || i == 27;
    EXPECT_TRUE(checksum || packet[i] == expected[i]) << i;
  }
  // A header with its checksum sums to all ones.
  const auto sum = [&](size_t from, size_t to, uint32_t start) {
    uint32_t total = start;
    for (size_t i = from; i < to; i += 2) total += uint32_t{packet[i]} << 8 | packet[i + 1];
    while (total > 0xFFFF) total = (total & 0xFFFF) + (total >> 16);
    return total;
  };
  EXPECT_EQ(sum(0, 20, 0), 0xFFFFu);
  EXPECT_EQ(sum(12, 30, 17 + 10), 0xFFFFu);  // addresses, protocol and length are summed with UDP's
}

TEST(Pcap, EthernetVlanAndCookedFramesAreUnwrapped) {
  const Bytes file = Captured({{7, 8, 9}});
  const Bytes packet(file.begin() + 40, file.end());
  const auto wrapped = [&](Bytes header) {
    header.insert(header.end(), packet.begin(), packet.end());
    header.insert(header.end(), 6, 0);  // Ethernet pads short frames
    return header;
  };
  const Bytes ethernet = wrapped({1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 0x08, 0x00});
  const Bytes vlan = wrapped({1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 0x81, 0x00, 0, 5, 0x08, 0x00});
  const Bytes cooked = wrapped(Bytes(16, 0));
  for (const auto& [frame, link] : {std::pair(ethernet, 1u), std::pair(vlan, 1u), std::pair(cooked, 113u)}) {
    const auto payload = UdpPayload(frame, link);
    ASSERT_TRUE(payload) << link;
    EXPECT_TRUE(std::ranges::equal(*payload, Bytes{7, 8, 9}));
  }
  EXPECT_FALSE(UdpPayload(ethernet, 147));
  Bytes fragment = packet;
  fragment[6] = 0x20;
  EXPECT_FALSE(UdpPayload(fragment, 101));
  Bytes tcp = packet;
  tcp[9] = 6;
  EXPECT_FALSE(UdpPayload(tcp, 101));
}

TEST(Pcap, NoFrameMakesItReadOutside) {
  std::mt19937 random(7);
  const Bytes file = Captured({Encoded(SomeEntity())});
  const Bytes packet(file.begin() + 40, file.end());
  Bytes ethernet = {1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 0x08, 0x00};
  ethernet.insert(ethernet.end(), packet.begin(), packet.end());
  size_t taken = 0;
  for (int i = 0; i < 100000; ++i) {
    Bytes frame(ethernet.begin(), ethernet.begin() + static_cast<std::ptrdiff_t>(random() % (ethernet.size() + 1)));
    if (random() % 4 == 0) frame = ethernet;
    for (int edit = 0; edit < 3 && !frame.empty(); ++edit) {
      frame[random() % std::min<size_t>(frame.size(), 60)] = static_cast<uint8_t>(random());
    }
    const auto payload = UdpPayload(frame, random() % 2 ? 1 : 101);
    if (!payload) continue;
    ASSERT_LE(payload->size(), frame.size());
    ++taken;
  }
  EXPECT_GT(taken, 100u);
}

TEST(Pcap, ADamagedFileIsReadAsFarAsItGoes) {
  const Bytes whole = Captured({Encoded(SomeEntity()), Encoded(SomeEntity())});
  const ScratchFile file("cut.pcap");
  file.Write(Bytes(whole.begin(), whole.end() - 10));
  auto reader = PcapReader::Open(file.path());
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->Next());
  EXPECT_FALSE(reader->Next());
  EXPECT_FALSE(reader->status().ok());
  EXPECT_NE(reader->status().message().find("frame 2"), std::string::npos);
}

TEST(Pcap, BigEndianFilesAndNanosecondsAreRead) {
  const Bytes packet_file = Captured({{5}});
  Bytes file = {0xA1, 0xB2, 0x3C, 0x4D, 0, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 101};
  const size_t packet_bytes = packet_file.size() - 40;
  for (const size_t word : {size_t{100}, size_t{500000000}, packet_bytes, packet_bytes}) {
    for (int shift = 24; shift >= 0; shift -= 8) file.push_back(static_cast<uint8_t>(word >> shift));
  }
  file.insert(file.end(), packet_file.begin() + 40, packet_file.end());
  const ScratchFile scratch("big.pcap");
  scratch.Write(file);
  auto reader = PcapReader::Open(scratch.path());
  ASSERT_TRUE(reader.ok());
  const auto datagram = reader->Next();
  ASSERT_TRUE(datagram);
  EXPECT_DOUBLE_EQ(datagram->utc_s, 100.5);
  EXPECT_TRUE(std::ranges::equal(datagram->bytes, Bytes{5}));
}

TEST(Pcap, OtherFilesAreOneDatagramOrRefused) {
  const ScratchFile raw("raw.bin");
  raw.Write(Encoded(SomeEntity()));
  auto reader = PcapReader::Open(raw.path());
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(std::ranges::equal(reader->Next()->bytes, Encoded(SomeEntity())));
  EXPECT_FALSE(reader->Next());
  raw.Write({});
  EXPECT_TRUE(PcapReader::Open(raw.path())->Next()->bytes.empty());
  raw.Write(Bytes(70000, 1));
  EXPECT_FALSE(PcapReader::Open(raw.path()).ok());
  raw.Write({0x0A, 0x0D, 0x0D, 0x0A, 0, 0});
  EXPECT_NE(PcapReader::Open(raw.path()).message().find("pcapng"), std::string::npos);
  EXPECT_FALSE(PcapReader::Open("/nowhere/at/all").ok());
  EXPECT_FALSE(PcapReader::Open(std::filesystem::temp_directory_path()).ok());
  EXPECT_FALSE(PcapWriter::Create("/nowhere/at/all").ok());
}

TEST(Recorder, RecordsWhatArrives) {
  const ScratchFile file("recorded.pcap");
  ListenOptions options;
  std::unique_ptr<Recorder> recorder;
  for (uint16_t port = 43200; port < 43300 && !recorder; ++port) {
    options.listen = {"127.0.0.1", port};
    auto started = Recorder::Start(options, file.path(), Clock::System());
    if (started.ok()) recorder = std::move(*started);
  }
  ASSERT_NE(recorder, nullptr);
  auto sender = UdpSender::Open(options.listen);
  ASSERT_TRUE(sender.ok());
  for (uint16_t entity = 1; entity <= 20; ++entity) ASSERT_TRUE((*sender)->Send(Encoded(SomeEntity(entity))).ok());
  while (recorder->datagrams() < 20) std::this_thread::yield();
  ASSERT_TRUE(recorder->Finish().ok());
  auto reader = PcapReader::Open(file.path());
  uint16_t entity = 0;
  while (const auto datagram = reader->Next()) {
    EXPECT_TRUE(std::ranges::equal(datagram->bytes, Encoded(SomeEntity(++entity))));
    EXPECT_GT(datagram->utc_s, 1.6e9);
  }
  EXPECT_EQ(entity, 20);
}

}  // namespace
}  // namespace belvedere::dis

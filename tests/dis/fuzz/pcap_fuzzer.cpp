// libFuzzer target: any bytes as a capture file, read as `belvedere-dis replay` and `decode` read it.
#include "dis/codec.h"
#include "dis/pcap.h"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace belvedere;
  static const std::string kPath =
      (std::filesystem::temp_directory_path() / ("pcap_fuzzer." + std::to_string(std::rand()))).string();
  {
    std::ofstream file(kPath, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  }
  auto reader = dis::PcapReader::Open(kPath);
  if (!reader.ok()) return 0;
  uint64_t frames = 0;
  while (const auto datagram = reader->Next()) {
    if (datagram->frame < frames) std::abort();
    frames = datagram->frame;
    dis::DatagramReader pdus(datagram->bytes);
    for (dis::Pdu pdu; pdus.Next(pdu);) {
    }
  }
  return 0;
}

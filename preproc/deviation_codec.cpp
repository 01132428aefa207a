#include "preproc/deviation_codec.h"

#include "runtime/paging/page_codec.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace belvedere {
namespace {

constexpr size_t kCount = static_cast<size_t>(kCells) * kCells;
constexpr size_t kPlanes = 2 * sizeof(uint64_t);  // of low and of high, byte by byte
constexpr size_t kRawBytes = kCount * kPlanes;
constexpr size_t kHeaderBytes = 8;
constexpr std::array<uint8_t, 4> kMagic{'B', 'V', 'D', 'V'};
constexpr int kZstdLevel = 3;

uint64_t Zigzag(int64_t value) {
  return static_cast<uint64_t>(value) << 1 ^ static_cast<uint64_t>(value >> 63);
}
int64_t Unzigzag(uint64_t value) {
  return static_cast<int64_t>(value >> 1) ^ -static_cast<int64_t>(value & 1);
}

void PutPlanes(uint64_t value, uint8_t* raw, size_t cell) {
  for (size_t byte = 0; byte < 8; ++byte) raw[byte * kCount + cell] = static_cast<uint8_t>(value >> (8 * byte));
}
uint64_t GetPlanes(const uint8_t* raw, size_t cell) {
  uint64_t value = 0;
  for (size_t byte = 0; byte < 8; ++byte) value |= uint64_t{raw[byte * kCount + cell]} << (8 * byte);
  return value;
}

uint32_t GetWord(std::span<const uint8_t> bytes) {
  uint32_t word = 0;
  for (size_t i = 0; i < 4; ++i) word |= uint32_t{bytes[i]} << (8 * i);
  return word;
}

}  // namespace

std::vector<uint8_t> EncodeDeviations(const CellDeviations& deviations) {
  BELVEDERE_CHECK(deviations.size() == kCount);
  std::vector<uint8_t> raw(kRawBytes);
  for (size_t cell = 0; cell < kCount; ++cell) {
    PutPlanes(Zigzag(deviations[cell].low), raw.data(), cell);
    PutPlanes(Zigzag(deviations[cell].high), raw.data() + kRawBytes / 2, cell);
  }
  std::vector<uint8_t> bytes(kHeaderBytes + ZSTD_compressBound(raw.size()));
  const size_t size =
      ZSTD_compress(bytes.data() + kHeaderBytes, bytes.size() - kHeaderBytes, raw.data(), raw.size(), kZstdLevel);
  BELVEDERE_CHECK(ZSTD_isError(size) == 0);
  bytes.resize(kHeaderBytes + size);
  const uint32_t crc = Crc32c(std::span(bytes).subspan(kHeaderBytes));
  std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
  for (size_t i = 0; i < 4; ++i) bytes[4 + i] = static_cast<uint8_t>(crc >> (8 * i));
  return bytes;
}

Result<CellDeviations> DecodeDeviations(std::span<const uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    return Status::Error("no deviations");
  if (Crc32c(bytes.subspan(kHeaderBytes)) != GetWord(bytes.subspan(4))) return Status::Error("wrong checksum");
  std::vector<uint8_t> raw(kRawBytes);
  const size_t size = ZSTD_decompress(raw.data(), raw.size(), bytes.data() + kHeaderBytes, bytes.size() - kHeaderBytes);
  if (size != kRawBytes) return Status::Error("deviations of a wrong size");
  CellDeviations deviations(kCount);
  for (size_t cell = 0; cell < kCount; ++cell) {
    const int64_t low = Unzigzag(GetPlanes(raw.data(), cell));
    const int64_t high = Unzigzag(GetPlanes(raw.data() + kRawBytes / 2, cell));
    deviations[cell] = {static_cast<int32_t>(low), static_cast<int32_t>(high)};
    if (deviations[cell].low != low || deviations[cell].high != high)
      return Status::Error("deviations of over a thousand kilometres");
  }
  return deviations;
}

}  // namespace belvedere

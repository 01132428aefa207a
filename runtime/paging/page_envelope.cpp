#include "runtime/paging/page_envelope.h"

#include <zstd.h>

#include <array>
#include <cstring>

namespace belvedere {
namespace {

constexpr uint8_t kCodecVersion = 1;
constexpr size_t kCheckedHeaderBytes = 16;

using Crc32cTables = std::array<std::array<uint32_t, 256>, 8>;

constexpr Crc32cTables MakeCrc32cTables() {
  constexpr uint32_t kReversedPolynomial = 0x82F63B78u;
  Crc32cTables tables{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? kReversedPolynomial : 0);
    tables[0][byte] = crc;
  }
  for (size_t k = 1; k < 8; ++k) {
    for (size_t byte = 0; byte < 256; ++byte) {
      const uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  }
  return tables;
}

void PutU16(std::vector<uint8_t>& out, uint16_t value) {
  out.push_back(static_cast<uint8_t>(value & 0xFF));
  out.push_back(static_cast<uint8_t>(value >> 8));
}
void PutU32(std::vector<uint8_t>& out, uint32_t value) {
  PutU16(out, static_cast<uint16_t>(value & 0xFFFF));
  PutU16(out, static_cast<uint16_t>(value >> 16));
}
uint32_t GetU32(const uint8_t* bytes) {
  return static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8 |
         static_cast<uint32_t>(bytes[2]) << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

// One zstd context a thread: creating one costs as much as a small page.
struct CompressionContext {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ~CompressionContext() { ZSTD_freeCCtx(context); }
};
struct DecompressionContext {
  ZSTD_DCtx* context = ZSTD_createDCtx();
  ~DecompressionContext() { ZSTD_freeDCtx(context); }
};

}  // namespace

uint32_t Crc32c(std::span<const uint8_t> bytes, uint32_t crc) {
  static constexpr Crc32cTables kTables = MakeCrc32cTables();
  crc = ~crc;
  size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    const uint32_t low = crc ^ GetU32(&bytes[at]);
    const uint32_t high = GetU32(&bytes[at + 4]);
    crc = kTables[7][low & 0xFF] ^ kTables[6][(low >> 8) & 0xFF] ^ kTables[5][(low >> 16) & 0xFF] ^
          kTables[4][low >> 24] ^ kTables[3][high & 0xFF] ^ kTables[2][(high >> 8) & 0xFF] ^
          kTables[1][(high >> 16) & 0xFF] ^ kTables[0][high >> 24];
  }
  for (; at < bytes.size(); ++at) crc = (crc >> 8) ^ kTables[0][(crc ^ bytes[at]) & 0xFF];
  return ~crc;
}

std::vector<uint8_t> WrapPage(uint8_t kind, uint16_t flags, std::span<const uint8_t> raw, int zstd_level) {
  thread_local CompressionContext compression;
  std::vector<uint8_t> payload(ZSTD_compressBound(raw.size()));
  const size_t size =
      ZSTD_compressCCtx(compression.context, payload.data(), payload.size(), raw.data(), raw.size(), zstd_level);
  BELVEDERE_CHECK(ZSTD_isError(size) == 0);
  std::vector<uint8_t> out;
  out.reserve(kPageHeaderBytes + size);
  for (const char c : {'B', 'V', 'P', 'G'}) out.push_back(static_cast<uint8_t>(c));
  out.push_back(kCodecVersion);
  out.push_back(kind);
  PutU16(out, flags);
  PutU32(out, static_cast<uint32_t>(raw.size()));
  PutU32(out, static_cast<uint32_t>(size));
  const std::span<const uint8_t> body(payload.data(), size);
  PutU32(out, Crc32c(body, Crc32c(std::span<const uint8_t>(out).first(kCheckedHeaderBytes))));
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

Status CheckPageHeader(std::span<const uint8_t> bytes, uint8_t kind) {
  if (bytes.size() < kPageHeaderBytes)
    return Status::Error("page of {} bytes is shorter than its header", bytes.size());
  if (std::memcmp(bytes.data(), "BVPG", 4) != 0) return Status::Error("page does not start with its mark BVPG");
  if (bytes[4] != kCodecVersion) {
    return Status::Error("page of version {}, this program reads version {}", bytes[4], kCodecVersion);
  }
  if (bytes[5] != kind) return Status::Error("page of kind {} where kind {} was expected", bytes[5], kind);
  if (GetU32(&bytes[12]) != bytes.size() - kPageHeaderBytes) return Status::Error("page is cut short or too long");
  const uint32_t crc = Crc32c(bytes.subspan(kPageHeaderBytes), Crc32c(bytes.first(kCheckedHeaderBytes)));
  if (crc != GetU32(&bytes[16])) return Status::Error("checksum does not match");
  return {};
}

uint32_t RawBytesOf(std::span<const uint8_t> bytes) {
  return GetU32(&bytes[8]);
}

Result<std::span<const uint8_t>> UnwrapPage(std::span<const uint8_t> bytes, size_t raw_size) {
  thread_local DecompressionContext decompression;
  thread_local std::vector<uint8_t> raw;
  if (RawBytesOf(bytes) != raw_size)
    return Status::Error("raw size {} where {} was expected", RawBytesOf(bytes), raw_size);
  raw.resize(raw_size);
  const auto payload = bytes.subspan(kPageHeaderBytes);
  const size_t size =
      ZSTD_decompressDCtx(decompression.context, raw.data(), raw.size(), payload.data(), payload.size());
  if (ZSTD_isError(size) != 0) return Status::Error("payload does not decompress: {}", ZSTD_getErrorName(size));
  if (size != raw_size) return Status::Error("payload decompresses to {} bytes, not {}", size, raw_size);
  return std::span<const uint8_t>(raw);
}

}  // namespace belvedere

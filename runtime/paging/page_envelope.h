// Page envelope: the header, checksum and compression that pages of every kind have in a dataset.
//
// 20 bytes, little-endian: magic "BVPG", u8 version, u8 kind, u16 flags, u32 raw size, u32 payload size, u32 CRC-32C of
// the first 16 header bytes and the payload, which is one zstd frame. docs/dataset-format.md has the kinds.
//
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

inline constexpr size_t kPageHeaderBytes = 20;

// CRC-32C (Castagnoli), as in RFC 3720; seed with 0, or with the CRC of what came before.
uint32_t Crc32c(std::span<const uint8_t> bytes, uint32_t crc = 0);

std::vector<uint8_t> WrapPage(uint8_t kind, uint16_t flags, std::span<const uint8_t> raw, int zstd_level);

// The reason alone when the bytes are no whole page of that kind.
Status CheckPageHeader(std::span<const uint8_t> bytes, uint8_t kind);
// How many raw bytes it says there are. REQUIRES: the header is good.
uint32_t RawBytesOf(std::span<const uint8_t> bytes);
// The raw bytes, in a buffer that the thread keeps until its next call. REQUIRES: the header is good.
Result<std::span<const uint8_t>> UnwrapPage(std::span<const uint8_t> bytes, size_t raw_size);

}  // namespace belvedere

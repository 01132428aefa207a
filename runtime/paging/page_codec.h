// Page codec: between pages in memory and their bytes in a dataset. docs/dataset-format.md has the layout.
//
// Every value starts with a 20-byte header (little-endian): magic "BVPG", u8 version, u8 kind, u16 flags, u32 raw size,
// u32 payload size, u32 CRC-32C of the first 16 header bytes and the payload. Elevation and images are lossless.
//
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/page.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace belvedere {

inline constexpr size_t kPageHeaderBytes = 20;
inline constexpr size_t kImageTexels = static_cast<size_t>(kImageSide) * static_cast<size_t>(kImageSide);

// CRC-32C (Castagnoli), as in RFC 3720; seed with 0, or with the CRC of what came before.
uint32_t Crc32c(std::span<const uint8_t> bytes, uint32_t crc = 0);

// REQUIRES: page.heights_mm.size() == kElevationSide^2
std::vector<uint8_t> EncodeElevation(const ElevationPage& page);
// rgba: kImageTexels x 4 bytes, level 0. Alpha is dropped where all of it is 255, and restored when decoded.
std::vector<uint8_t> EncodeImage(std::span<const uint8_t> rgba);

// The reason alone when the bytes are bad; the caller knows where they came from.
Result<std::shared_ptr<ElevationPage>> DecodeElevation(std::span<const uint8_t> bytes);
Result<std::shared_ptr<ImagePage>> DecodeImage(std::span<const uint8_t> bytes);

}  // namespace belvedere

// Page codec: between pages in memory and their bytes in a dataset. docs/dataset-format.md has the layout.
//
// All kinds have the same envelope (page_envelope.h). All are lossless.
//
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/page.h"
#include "runtime/paging/page_envelope.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace belvedere {

inline constexpr size_t kImageTexels = static_cast<size_t>(kImageSide) * static_cast<size_t>(kImageSide);

// REQUIRES: page.heights_mm.size() == kElevationSide^2
std::vector<uint8_t> EncodeElevation(const ElevationPage& page);
// rgba: kImageTexels x 4 bytes, level 0. Alpha is dropped where all of it is 255, and restored when decoded.
std::vector<uint8_t> EncodeImage(std::span<const uint8_t> rgba);
// REQUIRES: page.channels is 1 to 4, and there are as many planes of kElevationSide^2 values.
std::vector<uint8_t> EncodeProperty(const PropertyPage& page);

// The reason alone when the bytes are bad; the caller knows where they came from.
Result<std::shared_ptr<ElevationPage>> DecodeElevation(std::span<const uint8_t> bytes);
Result<std::shared_ptr<ImagePage>> DecodeImage(std::span<const uint8_t> bytes);
Result<std::shared_ptr<PropertyPage>> DecodeProperty(std::span<const uint8_t> bytes);

}  // namespace belvedere

// Deviation codec: how far the finest surface lies from a page's cells (surface_error.h), to bytes and back, exactly.
// The builder keeps it of pages with many finer ones under them, so that these need not be read again where only a part
// of them changes. docs/dataset-format.md has the layout.
//
// Threads: pure functions.
#pragma once

#include "preproc/surface_error.h"
#include "runtime/base/status.h"

#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

// REQUIRES: deviations.size() == kCells^2
std::vector<uint8_t> EncodeDeviations(const CellDeviations& deviations);
// The reason alone when the bytes are bad.
Result<CellDeviations> DecodeDeviations(std::span<const uint8_t> bytes);

}  // namespace belvedere

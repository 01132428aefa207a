// Vector codec: between pages of features and of buildings and their bytes in a dataset. docs/dataset-format.md has the
// layout. Features are lossless; lengths of buildings are rounded to a centimetre.
//
// Threads: pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/building_page.h"
#include "runtime/paging/vector_page.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace belvedere {

std::vector<uint8_t> EncodeVector(const VectorPage& page);
std::vector<uint8_t> EncodeBuildings(const BuildingPage& page);

// The reason alone when the bytes are bad; the caller knows where they came from. What is decoded is whole: every place
// that it names is there.
Result<std::shared_ptr<VectorPage>> DecodeVector(std::span<const uint8_t> bytes);
Result<std::shared_ptr<BuildingPage>> DecodeBuildings(std::span<const uint8_t> bytes);

}  // namespace belvedere

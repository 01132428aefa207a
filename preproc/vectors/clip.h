// Clip: features cut in two along a line of the grid, again and again until each part is in one quadnode.
//
// Where a line or a ring crosses, one point is made for both sides, so that they meet exactly. What runs along the line
// belongs to the side east or north of it.
//
// Threads: pure functions.
#pragma once

#include "preproc/vectors/feature.h"

#include <array>
#include <cstdint>
#include <vector>

namespace belvedere {

enum class GridAxis : uint8_t { kX, kY };

// What lies below `at`, west or south, and what lies above it. A ring that is cut follows the line on both sides
// (Sutherland, Hodgman: Reentrant polygon clipping, 1974).
std::array<FeatureParts, 2> CutInTwo(const FeatureParts& parts, FeatureShape shape, GridAxis axis, int64_t at);

}  // namespace belvedere

// Ground tint: colours by which one sees how the ground is drawn (GroundTint).
//
// Units: colours as RGBA, 8 bits each, red in the lowest. Threads: pure functions.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <array>
#include <cstdint>

namespace belvedere {

// Of a draw of the list: by error, level, frame and image, in the order of GroundTint.
std::array<uint32_t, kGroundTints - 1> TintsOf(const TerrainDraw& draw, const DisplayList& list);

// Blue where nothing is left, over green and yellow at the bound, to red at one and a half times it.
uint32_t ErrorColour(double error_px, double bound_px);

}  // namespace belvedere

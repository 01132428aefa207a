// Water mask: 255 where the ground is sea, 0 on land, so that the sun glints on water only.
//
// Sea is what lies at mean sea level or below, itself and, so that noise in flat coasts does not glitter, the ground
// around it on the mean. The step to land is soft, over kShore_m.
//
// Heights alone do not tell the sea from land below the sea's level: Death Valley, the Dead Sea's shore and the Dutch
// polders come out as water, and lakes above it as land.
//
// Threads: pure.
#pragma once

#include "runtime/earth/geoid.h"
#include "runtime/paging/page.h"

#include <memory>

namespace belvedere {

inline constexpr float kShore_m = 4;  // the height at which nothing is left of the water

// sea: height of mean sea level; nullptr: that of the ellipsoid. All mip levels are filled.
std::unique_ptr<ImagePage> MaskWater(const ElevationPage& heights, Quadcode node, const Geoid* sea);

}  // namespace belvedere

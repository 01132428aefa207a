// Watch outlines: the rims of watch areas as lines on the ground, for the display list.
//
// Frames: ECEF, metres.
// Threads: pure, as far as the RimHeight is.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/importance.h"

#include <functional>
#include <vector>

namespace belvedere {

inline constexpr int kRimPieces = 64;  // that one outline adds

// Height of the drawn ground above the ellipsoid, m, at a latitude and longitude in degrees.
using RimHeight = std::function<double(double latitude_deg, double longitude_deg)>;

// The rim is drawn a little above the ground, and more so the farther it is from the eye: what is drawn there is
// coarser.
void AddOutline(const WatchArea& area, const glm::dvec3& eye_ecef, const RimHeight& height,
                std::vector<EffectInstance>& effects);

}  // namespace belvedere

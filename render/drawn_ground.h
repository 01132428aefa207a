// Drawn ground: how high the surface that a list draws stands at a place. While pages come it may be far from the
// ground that is meant, and over the eye; then the picture is taken from just above it, since under it there is no
// picture.
//
// Units: degrees, metres above the ellipsoid.
// Threads: pure.
#pragma once

#include "runtime/earth/ellipsoid.h"
#include "runtime/scene/display_list.h"

#include <optional>

namespace belvedere {

// nullopt where the list draws nothing.
// since_list_s: since the list was made.
std::optional<double> DrawnGroundAt(const DisplayList& list, const Geodetic& place, double since_list_s);

}  // namespace belvedere

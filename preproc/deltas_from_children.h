// Deltas from children: where the builder's delta values come from (delta_values.h): the posts of a page's children,
// and between what depths and heights around them all that is finer still lies.
//
// Units: metres; heights over the ellipsoid. Threads: pure.
#pragma once

#include "preproc/surface_error.h"

#include <array>

namespace belvedere {

// Delta values of the page, which is done but for them, from its children, which are done.
// REQUIRES: node.level() < kMaxLevel
StoredDeltas DeltasFromChildren(Quadcode node, const ElevationPage& page, const std::array<BoundedPage, 4>& children);

}  // namespace belvedere

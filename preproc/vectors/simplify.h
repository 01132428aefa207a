// Simplify: lines and rings with fewer points (Douglas, Peucker: Algorithms for the reduction of the number of points,
// 1973). No point that is left out lies further than the tolerance from the line that is left.
//
// Threads: pure functions.
#pragma once

#include "preproc/vectors/feature.h"

#include <functional>

namespace belvedere {

struct Simplified {
  FeaturePart part;      // of a ring, empty where fewer than three points are left
  double deviation = 0;  // the furthest that a point left out lies from what is left, in grid units
};

// is_kept: points that stay whatever they add, besides the ends of a line. tolerance: grid units.
Simplified Simplify(const FeaturePart& part, FeatureShape shape, double tolerance,
                    const std::function<bool(const GridPlace&)>& is_kept);

}  // namespace belvedere

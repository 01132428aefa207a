// Surface error: how far a page's full-resolution triangles lie from those of the finer pages under it.
//
// Each cell between four posts is two triangles. The diagonal of cell (i, j), i to the east and j to the north from 0,
// runs from south-west to north-east where i + j is even, and from north-west to south-east where it is odd: the leaf
// triangles of a right-triangle bisection of the page. With this rule a child's triangles never cross a parent's edge,
// so the largest distance is at one of the child's posts.
//
// Threads: pure functions.
#pragma once

#include "runtime/paging/page.h"

#include <array>
#include <memory>
#include <vector>

namespace belvedere {

// Largest vertical distance, in metres, between the parent's triangles and the posts of its child `which` (Quadcode),
// for each block of the child.
std::array<double, ErrorBlocks{}.size()> DistanceFromParent(const ElevationPage& parent, const ElevationPage& child,
                                                            int which);

// Fills min_m, max_m, block_errors_m and error_m of a page: over its posts, and all that is finer where there are
// children (all four, with theirs already filled).
void BoundPage(ElevationPage& page, const std::array<std::shared_ptr<const ElevationPage>, 4>* children);

// The share of probes (ProbeLattice) that lie further than tolerance_m from the page's bilinear surface.
double ShareBeyond(const ElevationPage& page, const std::vector<double>& probe_heights_m, double tolerance_m);

}  // namespace belvedere

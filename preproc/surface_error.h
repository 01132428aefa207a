// Surface error: how far a page's full-resolution triangles lie from those of the finer pages under it.
//
// Each cell between four posts is two triangles. The diagonal of cell (i, j), i to the east and j to the north from 0,
// runs from south-west to north-east where i + j is even, and from north-west to south-east where it is odd: the leaf
// triangles of a right-triangle bisection of the page. With this rule a child's triangles never cross a parent's edge,
// so the largest distance is at one of the child's posts.
//
// Units: metres, or halves of a millimetre where it says so; heights over the ellipsoid. Threads: pure functions.
#pragma once

#include "runtime/paging/page.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace belvedere {

// By how much the finest surface lies over (high) and under (low) the triangles of a page, for each of its cells; row
// by row. In halves of a millimetre, which are exact: heights are millimetres, and posts of one level lie half-way
// between those of the one above. Both sides are kept apart until the page is stored: what one level adds and the next
// takes away must not count twice.
struct Deviation {
  int32_t low = 0, high = 0;
};
inline constexpr double kMetresPerDeviation = 0.0005;
using CellDeviations = std::vector<Deviation>;  // kCells^2

// What the levels above need of a page that is done.
struct BoundedPage {
  std::shared_ptr<const ElevationPage> page;
  CellDeviations deviations;
  int depth = 0;  // levels of finer pages under it; of pages that were not made anew (known_pages.h) three at most
};

// A page at a pole has children as wide as itself (quadcode.h), each in the place of its western half.
bool IsWide(Quadcode node, size_t child);
// Makes two pages of each such child, as there are elsewhere: the posts that it lacks lie half-way between its own, and
// the deviations say too how far its triangles are from those of the two.
void HalveWide(Quadcode node, std::array<BoundedPage, 4>& children);

// Fills min_m, max_m, block_errors_m and error_m of a page: over its posts, and all that is finer where there are
// children, all four (HalveWide). Returns the deviations of its cells: none of where nothing is finer.
CellDeviations BoundPage(ElevationPage& page, const std::array<BoundedPage, 4>* children);

}  // namespace belvedere

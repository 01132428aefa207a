// Delta values: how far the drawn surface may be from the finest one where a post is left out and the two triangles
// that it splits are drawn whole. page.h says what they promise, bisection.h which post splits what.
//
// A delta value is the most, over the points that the post's triangles cover, of the distance between the finest
// surface there and the triangle's point of the same column and row. Distances are cartesian, so they know of the
// Earth's curvature. What is still finer than those points is added to each of them, not to their maximum, so that a
// cliff and a rough block elsewhere do not add up.
//
// Values are found in floats, and hold but for their rounding: under a millimetre from level 8 on.
//
// Units: metres. Frames: vertices in any one, cartesian; heights over the ellipsoid. Threads: pure.
#pragma once

#include "runtime/paging/page.h"

#include <array>
#include <span>
#include <vector>

namespace belvedere {

// The finest surface under a quadnode, at points two to a cell both ways: where its children's posts are. Between
// `low` and `high` lies whatever the surface does in the children's cells around a point.
struct FinestSurface {
  static constexpr int kPerCell = 2;
  static constexpr int kSide = kPerCell * kCells + 1;
  std::vector<float> low_m, high_m;  // heights, kSide^2, row by row
};

// All: kVerticesPerPage; the corners, which split nothing, have the greatest.
//
// heights_m: of the quadnode's posts, above what the finest surface's are above. With P the ellipsoid's point, u its
// vertical and h a height, and w the shares of a triangle's corners in a point, the two surfaces are there
//     P - sum w P + (h - sum w h) u + sum w h (u - u of the corner)
// apart. Heights are compared on a paraboloid that is nearly the ellipsoid; what it leaves of the first term, along u
// and across it, is looked up in the ellipsoid itself, row by row; the last, which lies across, is bounded.
std::vector<float> DeltaValuesOf(Quadcode node, std::span<const float> heights_m, const FinestSurface& finest);
// Where the finest surface is the posts' own, but for errors_m left out around each post, block by block.
std::vector<float> DeltaValuesOf(std::span<const TerrainVertex> vertices, const ErrorBlocks& errors_m);

// TerrainPage::spread_m
std::array<float, kBisections> SpreadsOf(std::span<const TerrainVertex> vertices);

}  // namespace belvedere

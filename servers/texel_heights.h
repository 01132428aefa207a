// Texel heights: the heights of an elevation page at the texels of an image page, for layers that are made of heights.
//
// A texel in the gutter has the value that the neighbour has there. For what is taken from cells the apron would have
// to be one post wider: the outermost row and column of texels take the outermost cell's.
//
// Units: metres above mean sea level.
// Threads: pure.
#pragma once

#include "runtime/earth/geoid.h"
#include "runtime/paging/page.h"

#include <vector>

namespace belvedere {

inline constexpr double kPostsPerTexel = static_cast<double>(kCells) / kImageInner;

struct TexelHeight {
  float height_m = 0;  // between the four posts around the texel, bilinear
  float mean_m = 0;    // of the ground around it: between the means of the four cells around it, each of its 4 posts
  // How much the ground rises over one distance between posts, between the same cells.
  float rise_east_m = 0, rise_north_m = 0;
};

// One for each of kImageSide^2 texels. sea: height of mean sea level; nullptr: that of the ellipsoid.
std::vector<TexelHeight> HeightsAtTexels(const ElevationPage& page, Quadcode node, const Geoid* sea);

}  // namespace belvedere

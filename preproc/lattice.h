// Lattice: the positions of a page's posts or texels, so that a position has the same bits in every page that holds it.
//
// Positions are computed from integers that number them round the Earth, not from a page's corner: neighbours, also
// over 180 E and between trees, agree to the last bit. Rows that would lie beyond a pole are mirrored across it, half a
// turn further; posts of the pole row itself are all one position. So a page is one to three groups of rows, each with
// its own longitudes.
//
// Units: degrees; longitude [-180, 180), latitude [-90, 90].
// Threads: pure functions.
#pragma once

#include "runtime/earth/quadcode.h"

#include <vector>

namespace belvedere {

// Between positions along a parallel and along a meridian, degrees.
struct Spacing {
  double east_deg = 0, north_deg = 0;
};
// Of the posts of a quadnode, and of the texels of its image.
Spacing PostSpacingOf(Quadcode node);
Spacing TexelSpacingOf(Quadcode node);

struct LatticeRows {
  std::vector<double> longitudes_deg;  // as many as the page has columns; 1 for a pole's row
  std::vector<double> latitudes_deg;
  std::vector<int> rows;  // of the page, in which the latitudes go
};

// kElevationSide posts a side.
std::vector<LatticeRows> PostLattice(Quadcode node);
// Posts of the node's level, from west and south of its own south-west post on, which may be less than 0; rows say the
// same of each latitude. What would lie beyond a pole is not there. REQUIRES: some row is not beyond a pole.
LatticeRows PostsAround(Quadcode node, int west, int south, int columns, int rows);
// kImageSide texels a side.
std::vector<LatticeRows> TexelLattice(Quadcode node);

}  // namespace belvedere

// Shaded relief: an image of how light from the north-west, halfway up the sky, falls on the heights. Multiplied with
// the ground's colour it shows relief wherever the sun stands, and finer than the vertices do.
//
// Texels run from dark slopes that look to the south-east, over 128 (exactly) for flat ground, which leaves the colour
// as it is, to bright slopes that look to the north-west.
//
// Slopes are taken between the four posts of each cell, in metres (so they know of the latitude), and are bilinear from
// cell to cell. A texel in the gutter has the value that the neighbour has there, but for the outermost row, for which
// the apron would have to be one post wider: it takes the slope of the outermost cell.
//
// Coarse levels have gentle slopes, as their posts lie far apart; their slopes are raised by the power 0.7 of the
// distance between posts over 400 m, so that continents show relief from space, as on a printed map. Under the sea
// slopes count for less: the eye expects an even ocean, and a hint of the ridges is enough.
//
// Threads: pure.
#pragma once

#include "runtime/earth/geoid.h"
#include "runtime/paging/page.h"

#include <memory>

namespace belvedere {

// sea: height of mean sea level; nullptr: that of the ellipsoid. All mip levels are filled.
std::unique_ptr<ImagePage> ShadeRelief(const ElevationPage& heights, Quadcode node, const Geoid* sea);

}  // namespace belvedere

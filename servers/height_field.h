// HeightField: the heights and slopes of one quadnode's posts, taken from its own elevation page, from an ancestor's,
// or from none. Where the ancestor's posts are wider apart, heights and slopes are bilinear between them, evaluated so
// that a value on a shared border has the same bits whichever quadnode asks.
//
// Units: metres; slopes are rise over run, to the east and to the north.
// Threads: values.
#pragma once

#include "runtime/paging/page.h"

#include <vector>

namespace belvedere {

struct HeightField {
  std::vector<double> height_m;   // kVerticesPerPage
  std::vector<float> slope_east;  // kVerticesPerPage; 0 at a pole
  std::vector<float> slope_north;
};

// page: of heights_node, which is node or an ancestor of it; nullptr gives a flat field. Heights are multiplied by
// `exaggeration`.
HeightField SampleHeights(Quadcode node, const ElevationPage* page, Quadcode heights_node, double exaggeration);

}  // namespace belvedere

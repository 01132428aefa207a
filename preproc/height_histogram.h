// HeightHistogram: how the heights of a layer are spread, from a bounded number of its finest pages.
//
// Each place counts where it is finest: in the pages that have no children. Where there are more than may be read,
// every so-many-th in the order of the quadcodes is, which says of all what it says of a sample.
//
// Units: metres above the ellipsoid.
// Threads: a pure function that reads pages.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <cstdint>
#include <vector>

namespace belvedere {

struct HeightHistogram {
  double first_m = 0, step_m = 1;      // bar i holds heights from first_m + i * step_m to the next
  std::vector<int64_t> posts;          // by bar
  int64_t pages_read = 0, pages = 0;   // of the finest
  double lowest_m = 0, highest_m = 0;  // of all posts of the layer
};

// Bars of a step of 1, 2 or 5 times a power of ten, at most most_bars. REQUIRES: the layer holds heights.
Result<HeightHistogram> CountHeights(const Dataset& dataset, int layer, int most_pages, int most_bars);

}  // namespace belvedere

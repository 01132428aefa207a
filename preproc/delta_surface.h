// Delta surface: how far a source lies over what is below it, carried on over the source's voids.
//
// Grohman, Kroenung and Strebeck (2006, "Filling SRTM voids: the delta surface fill method", Photogrammetric
// Engineering and Remote Sensing 72) fill a void with another source, shifted by a surface that is interpolated from
// the differences of the two at the void's rim, so that there is no cliff. The interpolation is Shepard's with the
// weights of Franke and Nielson (1980, "Smooth interpolation of large sets of scattered data"): ((reach - d) / (reach
// d))^2 of the distance d to each post of the rim, which takes the rim's own value at the rim and nothing from beyond
// the reach. From half of the reach on the surface fades to 0, and the void is filled by what lies below as it is.
//
// A post's value depends on the posts within its reach alone, summed in the order of rows and columns: it has the same
// bits in every grid that holds them all.
//
// Units: metres. Rows run from the south.
// Threads: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace belvedere {

struct DeltaGrid {
  enum class Post : uint8_t { kOutside, kValid, kVoid };
  int columns = 0, rows = 0;
  double row_m = 0;              // between rows
  std::vector<double> column_m;  // between columns, of each row
  std::vector<Post> posts;       // row by row
  std::vector<double> deltas_m;  // of valid posts
};

// Sets deltas_m of the void posts in rows [south, north) and columns [west, east).
struct GridRange {
  int west = 0, south = 0, east = 0, north = 0;
};
void FillVoids(DeltaGrid& grid, const GridRange& range, double reach_m);

}  // namespace belvedere

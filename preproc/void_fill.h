// VoidFill: what is added to the ground below a source in its voids, so that it meets the source at their rims.
//
// The delta surface of a source (delta_surface.h) is made on the posts of quadnodes, of the level that is asked for or
// of the source's finest, whichever is coarser, with as much around them as the surface reaches; between posts it is
// bilinear. So it depends on the position, the level and the sources alone. It reaches 64 of the source's pixels: a
// void that is 64 wide is filled with it from rim to rim.
//
// Units: metres; degrees.
// Threads: one VoidFill a thread.
// Owns: the surfaces of the kMostTiles quadnodes last used.
#pragma once

#include "preproc/delta_surface.h"
#include "preproc/georeference.h"
#include "preproc/lattice.h"
#include "runtime/earth/quadcode.h"

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <utility>
#include <vector>

namespace belvedere {

class VoidFill {
 public:
  // A source, unfeathered, and what is below it at posts of a level; heights above the ellipsoid.
  struct Ground {
    std::vector<DeltaGrid::Post> posts;
    std::vector<double> source_m, below_m;
  };
  // lattice: posts as far apart as those of the quadnode. May ask this very VoidFill for the surfaces of sources below.
  using GroundOf = std::function<Ground(size_t source, const LatticeRows& lattice, Quadcode node)>;
  explicit VoidFill(GroundOf ground_of) : ground_of_(std::move(ground_of)) {}

  double DeltaAt(size_t source, const Georeference& georeference, int level, double longitude_deg, double latitude_deg);

 private:
  static constexpr size_t kMostTiles = 64;
  struct Tile {
    size_t source = 0;
    Quadcode node;
    std::vector<double> deltas_m;  // kPosts^2 from the south-west; NaN where the source has neither data nor a void
  };
  std::shared_ptr<const Tile> TileOf(size_t source, Quadcode node, double reach_m);
  std::vector<double> Make(size_t source, Quadcode node, double reach_m) const;

  const GroundOf ground_of_;
  std::list<std::shared_ptr<const Tile>> tiles_;  // most recently used first
};

}  // namespace belvedere

// Plan: which quadnodes a layer gets, from where its sources lie and how fine they are.
//
// Level 0 has all 32 quadnodes. A quadnode has children, all of them, where some source that is finer than it overlaps
// it.
//
// Threads: pure functions.
#pragma once

#include "preproc/georeference.h"
#include "runtime/earth/quadcode.h"
#include "runtime/paging/dataset.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

struct PlannedSource {
  GeoBox extent;
  int finest_level = 0;
  double spacing_deg = 1;  // between its pixels
  bool timed = false;      // it is of one time of its layer
};

// The places of a layer's sources when the finest is to be last: those of one resolution, to a thousandth, as they
// were, and those of a time over those without.
std::vector<size_t> PlacesByResolution(std::span<const PlannedSource> sources);

// The coarsest level whose posts or texels are no further apart than a source's pixels.
int FinestLevel(double spacing_deg, LayerKind kind);
// The finest level that a source brings to the quadnode, which may be coarser than the quadnode; 0 where there is none.
int SourceLevel(std::span<const PlannedSource> sources, Quadcode node);
// Quadnodes of the layer.
int64_t CountNodes(std::span<const PlannedSource> sources);
// The same, of the quadnode and those under it. REQUIRES: the plan has the quadnode.
int64_t CountNodesUnder(std::span<const PlannedSource> sources, Quadcode node);

}  // namespace belvedere

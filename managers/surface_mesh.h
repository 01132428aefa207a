// Surface mesh: the second stage of terrain selection. Chooses posts within each quadnode of a cut by their delta
// values (post_selection.h), or keeps what it chose before (kept_triangles.h), joins all quadnodes into one watertight
// surface, and lets it grow out of the surface before it (surface_morph.h).
//
// Between quadnodes, each side chooses for itself; then the line that they share is made the same for both. All posts
// that lie on a border line and are drawn by any quadnode are gathered; each position gets one canonical vertex (that
// of the narrowest quadnode; border_lines.h); and a triangle whose edge lies on the line is cut as a fan at every
// canonical vertex of that edge (border_joiner.h). This works for quadnodes of any
// levels, across quadtrees, frames and 180 E. On a pole line all positions are one point, hence one vertex.
//
// All of that is done again only where something changed since the list before, and around it (reach.h).
//
// Threads: pure.
#pragma once

#include "managers/border_lines.h"
#include "managers/cut.h"
#include "managers/kept_triangles.h"
#include "managers/surface_morph.h"
#include "runtime/scene/display_list.h"

#include <glm/vec3.hpp>

#include <span>

namespace belvedere {

struct MeshStatistics {
  uint32_t triangles = 0;
  double rises_until_s = 0;      // see DisplayList::Statistics
  double achieved_error_px = 0;  // largest screen-space error that the visible quadnodes' triangles may leave
};

// What goes on from list to list of one manager.
struct SurfaceState {
  KeptTriangles kept;
  SurfaceMorph morph;
  BorderLines lines;  // of the list in the making
};

// Appends to list.vertices, list.indices, list.frames and list.terrain_draws (one draw a cut node, in the same order),
// and says until when vertices are on their way. REQUIRES: state.morph has begun the list.
MeshStatistics BuildSurface(std::span<const CutNode> nodes, const Sight& sight, double error_px, SurfaceState& state,
                            DisplayList& list);

}  // namespace belvedere

// Surface mesh: the second stage of terrain selection. Chooses posts within each quadnode of a cut by their delta
// values (post_selection.h), or keeps what it chose before (kept_triangles.h), and joins all quadnodes into one
// watertight surface.
//
// Between quadnodes, each side chooses for itself; then the line that they share is made the same for both. All posts
// that lie on a border line and are drawn by any quadnode are gathered; each position gets one canonical vertex (that
// of the finest quadnode, and among equals of the least quadcode); and a triangle whose edge lies on the line is cut as
// a fan at every canonical vertex of that edge. This works for quadnodes of any levels, across quadtrees, frames and
// 180 E. On a pole line all positions are one point, hence one vertex.
//
// Threads: pure.
#pragma once

#include "managers/cut.h"
#include "managers/kept_triangles.h"
#include "runtime/scene/display_list.h"

#include <glm/vec3.hpp>

#include <span>

namespace belvedere {

struct MeshStatistics {
  uint32_t triangles = 0;
  double achieved_error_px = 0;  // largest screen-space error that the visible quadnodes' triangles may leave
};

// Appends to list.indices, list.slots, list.frames and list.terrain_draws (one draw a cut node, in the same order).
// kept: of the manager whose lists these are.
MeshStatistics BuildSurface(std::span<const CutNode> nodes, const Sight& sight, double error_px, KeptTriangles& kept,
                            DisplayList& list);

}  // namespace belvedere

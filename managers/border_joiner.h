// Border joiner: makes the triangles of one quadnode meet its neighbours' along its borders.
//
// A triangle whose edge lies on a border is cut as a fan at every canonical vertex of that edge (border_lines.h), so
// that both sides have the same vertices there. At a pole a border is one vertex.
//
// Threads: pure.
#pragma once

#include "managers/border_lines.h"
#include "managers/cut.h"
#include "managers/kept_triangles.h"

#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

// The corners that each pole is drawn at: those of the best-ranked quadnode that touches it.
struct PoleCorners {
  uint32_t north = 0, south = 0;
};
PoleCorners PoleCornersOf(std::span<const CutNode> nodes, std::span<const KeptMesh* const> meshes,
                          std::span<const uint32_t> ranked);

// Adds the drawn posts of a quadnode that lie on its borders. number: of the quadnode in the cut; rank: among all of
// the cut, narrowest first.
void AddBorderPosts(const CutNode& node, const KeptMesh& mesh, uint32_t number, uint32_t rank, BorderLines& lines);

// Appends to `out` the corners of the triangles at the quadnode's border, three a triangle.
void JoinBorders(const CutNode& node, const KeptMesh& mesh, uint32_t number, const BorderLines& lines,
                 const PoleCorners& poles, std::vector<uint32_t>& out);

}  // namespace belvedere

// Reach: what a change of some quadnodes' meshes asks of the others.
//
// Where a quadnode's mesh is new, or a quadnode has gone, whatever touches it has to be joined to its neighbours again.
// Whoever is joined again needs the border posts of all that touch it. Everything else stays as it was in the list
// before. All quadnodes at a pole touch each other.
//
// Threads: pure.
#pragma once

#include "runtime/earth/quadcode.h"

#include <span>
#include <vector>

namespace belvedere {

// Whether the two have a point of their borders in common, or overlap.
bool Touch(Quadcode a, Quadcode b);

struct Reach {
  std::vector<bool> joined;  // of each quadnode: it is joined to its neighbours again
  std::vector<bool> asked;   // it is, or touches one that is
};

// is_new: of each of nodes. gone: quadnodes of the list before that are not among nodes.
Reach ReachOf(std::span<const Quadcode> nodes, const std::vector<bool>& is_new, std::span<const Quadcode> gone);

}  // namespace belvedere

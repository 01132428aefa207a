// Delta values: how far the drawn surface may be from the full one where a post, and all that depend on it, are left
// out. terrain_builder.h says what they promise, bisection.h which post splits what.
//
// Units: metres. Threads: pure.
#pragma once

#include "runtime/paging/page.h"

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace belvedere {

// vertices: kVerticesPerPage. errors_m: what the page leaves out with every post drawn, block by block; the most of the
// blocks that a post's triangles touch is added to its delta value.
std::vector<float> DeltaValues(std::span<const TerrainVertex> vertices, const ErrorBlocks& errors_m);

// For each level of bisection, a distance within which all posts lie that depend on one of that level.
std::array<float, kBisections> ReachOfLevels(std::span<const TerrainVertex> vertices);

}  // namespace belvedere

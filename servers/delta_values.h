// Delta values: how far the drawn surface may be from the finest one where a post is left out and the two triangles
// that it splits are drawn whole. page.h says what they promise, bisection.h which post splits what.
//
// Units: metres. Threads: pure.
#pragma once

#include "runtime/paging/page.h"

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace belvedere {

struct DeltaValues {
  std::vector<float> deltas_m;                // kVerticesPerPage
  std::array<float, kBisections> spread_m{};  // TerrainPage::spread_m
};

// vertices: kVerticesPerPage. errors_m: what the page leaves out with every post drawn, block by block. A delta value
// is the most, over the posts that the triangles without the post cover, of a post's distance from them and the
// errors_m around it: taken post by post, so that a cliff and a rough block elsewhere do not add up.
DeltaValues DeltaValuesOf(std::span<const TerrainVertex> vertices, const ErrorBlocks& errors_m);

}  // namespace belvedere

// Footprint: the outline of a building on the level, in metres from its anchor, and triangles that fill it.
//
// Threads: pure functions.
#pragma once

#include "preproc/vectors/roof.h"
#include "runtime/earth/quadcode.h"
#include "runtime/paging/vector_page.h"

#include <glm/vec2.hpp>

#include <array>
#include <optional>
#include <vector>

namespace belvedere {

struct Footprint {
  GridPoint anchor;                                  // the middle of its extent
  std::vector<std::vector<glm::dvec2>> rings;        // east and north; what is inside lies on the left
  std::vector<std::array<glm::dvec2, 3>> triangles;  // counter-clockwise
  RoofFrame frame;                                   // of the smallest rectangle around it
  double radius_m = 0;                               // of its points from the anchor
  double box_error_m = 0;                            // how far the rectangle reaches beyond it

  // The rectangle alone.
  Footprint Box() const;
};

// Nothing where it has no area. An outline that crosses itself is taken apart where it does.
std::optional<Footprint> FootprintOf(const VectorPage& page, const VectorFeature& feature, Quadcode node);

}  // namespace belvedere

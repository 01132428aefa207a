// Feature: a road, a river, a place, a building, as read from a source, whole and on the Earth's grid.
//
// Coordinates are grid units (quadcode.h) counted on beyond 180 E and 180 W, so that a line that crosses 180 has no
// jump; y from 90 S.
// Threads: values.
#pragma once

#include "runtime/paging/vector_page.h"

#include <compare>
#include <cstdint>
#include <vector>

namespace belvedere {

struct GridPlace {
  int64_t x = 0, y = 0;
  auto operator<=>(const GridPlace&) const = default;
};
using FeaturePart = std::vector<GridPlace>;

struct Feature {
  uint32_t id = 0;
  FeatureClass of = FeatureClass::kOther;
  FeatureShape shape = FeatureShape::kPoints;
  // Where not all fit a page, those with more come first.
  double importance = 0;
  double resolution = 0;  // grid units that its points may be off by where it is shown finest
  // As in VectorPage: of points one part; of polygons rings, open and even-odd.
  std::vector<FeaturePart> parts;
  std::vector<Attribute> attributes;
};

}  // namespace belvedere

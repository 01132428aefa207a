// BuildingPage: the buildings of a quadnode as models, in a few levels of detail.
//
// A building's vertices are metres east, north and up in the level frame of its anchor, a point of the Earth; up counts
// from the ground there. So a page does not depend on elevation: whoever draws it sets each building on the ground that
// is drawn.
//
// Threads: values.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/paging/page.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace belvedere {

struct BuildingVertex {
  float east_m = 0, north_m = 0, up_m = 0;
  std::array<int8_t, 3> normal{};   // east, north, up; -127 to 127 is -1 to 1
  std::array<uint8_t, 3> colour{};  // sRGB
  uint16_t building = 0;            // its place in `buildings`
};

struct Building {
  uint32_t feature = 0;  // its id in the vector layer that it was made of
  GridPoint anchor;
  float height_m = 0;  // of its highest vertex
  float radius_m = 0;  // no vertex is further from the anchor, measured on the level
};

struct BuildingPage final : Page {
  // One level of detail: a range of `indices`, 3 a triangle, counter-clockwise seen from outside.
  struct Detail {
    uint32_t first_index = 0, indices = 0;
    float error_m = 0;  // how far its surface may lie from the finest one's
  };
  std::vector<Building> buildings;
  std::vector<BuildingVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<Detail> details;  // finest first; none where there is no building

  size_t bytes() const override {
    return sizeof(*this) + buildings.capacity() * sizeof(Building) + vertices.capacity() * sizeof(BuildingVertex) +
           indices.capacity() * sizeof(uint32_t) + details.capacity() * sizeof(Detail);
  }
};

}  // namespace belvedere

// Height of the ground under a position, from the finest terrain page that is in memory. Never waits, never reads.
//
// Used to keep eyes above the ground and to stand vehicles on it.
// Units: degrees, metres above the ellipsoid (times the station's vertical exaggeration, as drawn).
// Threads: any.
#pragma once

#include "runtime/paging/paging.h"

#include <optional>

namespace belvedere {

struct GroundPoint {
  double height_m = 0;
  glm::dvec3 normal_ecef{};  // of the triangle under the position, outwards
  int level = 0;             // of the page
};

// nullopt while not even the root page is in memory.
std::optional<GroundPoint> GroundUnder(Paging& paging, DataType terrain, double latitude_deg, double longitude_deg);

// The same on one page. REQUIRES: the page's quadnode contains the position.
GroundPoint GroundOnPage(const TerrainPage& page, double latitude_deg, double longitude_deg);

}  // namespace belvedere

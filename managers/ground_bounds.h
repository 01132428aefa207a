// Ground bounds: what the ground of a quadnode fits into, tighter than its page's sphere.
//
// A box along the ground, from east to west and from north to south; and, of a quadnode that is so wide in degrees that
// parallels bend within it (quadcode.h), the convex hull of its corners and of points that hold the arc of its longer
// parallel: by a pole the box is mostly of its neighbours.
//
// Units: metres. Frames: ECEF. Threads: values.
#pragma once

#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/page.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace belvedere {

class GroundBounds {
 public:
  explicit GroundBounds(const TerrainPage& page);
  // Of large quadnodes a sphere says as much.
  static bool AreWorthTheirMaking(Quadcode node);

  double DistanceTo(const glm::dvec3& ecef) const;
  // Least of dot(point - from, direction) over the ground.
  double LeastAlong(const glm::dvec3& from, const glm::dvec3& direction) const;

 private:
  void MakeHull(const TerrainPage& page, const GeoBox& box);

  glm::dvec3 center_ecef_{};
  LevelAxes axes_;
  glm::dvec3 half_{};  // along east, north, up
  std::array<glm::dvec3, 12> hull_ecef_{};
  size_t hull_points_ = 0;  // 0: there is the box alone
};

}  // namespace belvedere

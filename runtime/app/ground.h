// Ground: where a line of sight meets the terrain, given a function that knows its height.
//
// Frames: ECEF, metres; heights above the ellipsoid.
// Threads: pure functions, as far as the GroundHeight is.
#pragma once

#include "runtime/earth/ground_height.h"

#include <glm/vec3.hpp>

#include <optional>

namespace belvedere {

struct SightLine {
  glm::dvec3 origin_ecef{};
  glm::dvec3 direction{};  // unit length
};

// Distance along the line to the ellipsoid raised by height_m; nullopt when it passes by or only lies behind. From
// inside, the distance to the way out.
std::optional<double> DistanceToEllipsoid(const SightLine& line, double height_m);

// The first point of the ground on the line; nullopt when it meets none. An eye under the ground meets it at once.
std::optional<glm::dvec3> MeetGround(const SightLine& line, const GroundHeight& ground);

// The point of the line that is nearest to the ellipsoid's centre, brought down onto the ellipsoid: where somebody who
// points past the limb of the Earth is taken to point.
glm::dvec3 NearestOnLimb(const SightLine& line);

}  // namespace belvedere

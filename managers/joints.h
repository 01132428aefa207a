// Joints: how the parts of a model stand, from what an entity's articulated parts and its appearance say.
//
// Part classes and metrics are those of SISO-REF-010: primary turret 1 (4096) and primary gun 1 (4416) by azimuth and
// elevation, which go on by their rates; landing gear (3072) by its position or extension; what has no such part but an
// appearance that says so (gear down, hatch open) likewise.
//
// Units:   radians, seconds.
// Threads: pure.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/object_table.h"

namespace belvedere {

// spin_radps: how fast rotors and propellers turn, 0 with the engine off.
struct JointsOf {
  JointPose pose;
  float spin_radps = 0;
};
JointsOf JointsAt(const ObjectRecord& record, double now_s);

// A life form that lies, crawls or swims is turned onto its front; one that kneels, sits, squats, crouches or wades is
// as much lower as its head is then: what of its legs is in the ground is not seen.
struct Posture {
  glm::dmat3 ecef_from_body{1.0};
  double lowered_m = 0;
};
Posture PostureOf(const ObjectRecord& record, const glm::dmat3& ecef_from_body);

}  // namespace belvedere

#include "managers/eye_jump.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace belvedere {

bool EyeJump::Next(const ViewParameters& view, double now_s, double height_above_ground_m, bool settled) {
  const glm::dvec3 eye_ecef = view.EyeAt(now_s);
  const glm::dvec3 backward = view.ecef_from_camera[2];
  const double passed_s = now_s - last_s_;
  const double height_m = std::max(height_above_ground_m, 10.0);
  const double flown_m =
      2.0 * glm::length(view.eye_velocity_mps) * passed_s + height_m * std::max(kHeightsPerSecond * passed_s, 0.25);
  const bool jumps =
      !any_ || glm::distance(eye_ecef, eye_ecef_) > flown_m || glm::dot(backward, backward_) < kLeastCosine;
  if (jumps) {
    jumping_ = true;
    jumped_s_ = now_s;
  } else if (settled || now_s - jumped_s_ > kMost_s) {
    jumping_ = false;
  }
  any_ = true;
  last_s_ = now_s;
  eye_ecef_ = eye_ecef;
  backward_ = backward;
  return jumping_;
}

}  // namespace belvedere

// Eye jump: whether a view's surface may jump since its eye has, or must go smoothly from list to list.
//
// The eye jumps when it is further from where it was than any flight takes it, or looks another way altogether. From
// then on until the view has settled, and no longer than kMost_s, pages that arrive are shown at once.
//
// Units: metres, clock seconds. Threads: one an object.
#pragma once

#include "runtime/scene/view_parameters.h"

namespace belvedere {

class EyeJump {
 public:
  static constexpr double kMost_s = 2.0;
  static constexpr double kHeightsPerSecond = 3.0;  // that a flight covers at most
  static constexpr double kLeastCosine = 0.87;      // of the angle through which a flight turns between two lists

  // For the list of that time. settled: the list before it was, for the view of its time.
  bool Next(const ViewParameters& view, double now_s, double height_above_ground_m, bool settled);

 private:
  double last_s_ = 0;
  double jumped_s_ = 0;
  bool any_ = false;
  bool jumping_ = true;
  glm::dvec3 eye_ecef_{};
  glm::dvec3 backward_{};
};

}  // namespace belvedere

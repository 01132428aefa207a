// WatchOutlines: the rims of watch areas as lines on the ground, for the display lists of one view.
//
// Where the ground lies under them is looked up when the areas are others, and once a second, since finer pages come;
// not for every list.
//
// Frames:  ECEF, metres; clock seconds.
// Threads: the object manager's.
#pragma once

#include "runtime/earth/ground_height.h"
#include "runtime/scene/display_list.h"
#include "runtime/scene/importance.h"

#include <array>
#include <memory>
#include <vector>

namespace belvedere {

inline constexpr size_t kRimPieces = 64;  // that one outline adds
inline constexpr double kRimHolds_s = 1.0;

class WatchOutlines {
 public:
  using Areas = std::shared_ptr<const std::vector<WatchArea>>;

  // Whether Add would give others, for the same eye.
  bool AreDue(const Areas& areas, double now_s) const {
    return areas != areas_ || (areas != nullptr && now_s >= due_s_);
  }
  // As many as kMostEffects leaves room for. A rim is drawn a little above the ground, and more so the farther it is
  // from the eye: what is drawn there is coarser. areas: nullptr where there are none.
  void Add(const Areas& areas, const glm::dvec3& eye_ecef, double now_s, const GroundHeight& ground,
           std::vector<EffectInstance>& effects);

 private:
  using Rim = std::array<glm::dvec3, kRimPieces>;
  static Rim RimOf(const WatchArea& area, const GroundHeight& ground);

  Areas areas_;
  std::vector<Rim> rims_;
  double due_s_ = 0;
};

}  // namespace belvedere

// Picture sides: what of a quadnode lies beside the picture, seen from within a frame.
//
// Only the sides beyond which something of the quadnode may lie are looked at: none for one that is wholly in the
// picture, nor where Sight does not know them.
//
// Units: metres. Frames: the quadnode's. Threads: values.
#pragma once

#include "managers/cut.h"
#include "runtime/earth/frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <span>

namespace belvedere {

class PictureSides {
 public:
  PictureSides(const CutNode& node, const Sight& sight, const Frame& frame) : eye_(frame.ToFrame(sight.eye_ecef)) {
    if (!sight.perspective || !node.visible) return;
    for (const glm::dvec3& inward_ecef : sight.inwards_ecef) {
      const double least_m = glm::dot(node.page->center_ecef - sight.eye_ecef, inward_ecef) - node.page->radius_m;
      if (least_m < 0) inwards_[count_++] = glm::vec3(inward_ecef * frame.ecef_from_frame);
    }
  }

  bool any() const { return count_ > 0; }

  // All within spread_m of the place is beyond one of the sides, and by the sine `guard` of an angle at least.
  bool IsBeyond(const glm::vec3& place, float spread_m, float guard) const {
    const glm::vec3 away = place - eye_;
    const float beyond_m = spread_m + guard * (glm::length(away) + spread_m);
    return std::any_of(inwards_.begin(), inwards_.begin() + count_,
                       [&](const glm::vec3& inward) { return glm::dot(away, inward) < -beyond_m; });
  }

  // The same of all that has these corners, and of what is within margin_m of it: the corners say it, for the share of
  // the distance by which a place is beyond a side is least at one of them.
  bool AreBeyond(std::span<const glm::vec3> corners, float margin_m, float guard) const {
    return std::any_of(inwards_.begin(), inwards_.begin() + count_, [&](const glm::vec3& inward) {
      return std::all_of(corners.begin(), corners.end(), [&](const glm::vec3& corner) {
        const glm::vec3 away = corner - eye_;
        return glm::dot(away, inward) < -(margin_m + guard * glm::length(away));
      });
    });
  }

 private:
  glm::vec3 eye_;
  std::array<glm::vec3, 4> inwards_{};  // unit normals, towards the picture
  size_t count_ = 0;
};

}  // namespace belvedere

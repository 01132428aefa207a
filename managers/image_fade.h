// Image fade: when another image is laid on a quadnode, finer or coarser or of another step of its layer, it does not
// appear at once: it is blended in over the one before within kFade_s, for the two lowest layers of a view.
//
// What was there before is the image that the list before had on the quadnode, or the part of it that the quadnode
// covers of an ancestor's. While one image is still being blended in, the next one waits. Where four quadnodes give way
// to their parent there is no one image to start from; then the eye is going away, and texels are smaller than a pixel.
//
// Units: clock seconds. Threads: one an object.
#pragma once

#include "managers/cut.h"

#include <span>
#include <unordered_map>

namespace belvedere {

class ImageFade {
 public:
  static constexpr double kFade_s = 0.3;

  // Sets what the nodes' images are blended in over. layers: of the view. jump: all is shown at once, for the eye has
  // jumped.
  void Apply(std::span<CutNode> nodes, std::span<const LayerUse> layers, double now_s, bool jump, PageAccess& pages);

  // When all that the last list shows is blended in, clock seconds.
  double until_s() const { return until_s_; }
  // Whether an image of the last list waits for the one before it: another list has to be made.
  bool waits() const { return waits_; }

 private:
  struct Shown {
    std::array<ImageUse, kFadingLayers> images;
    std::array<ImageUse, kFadingLayers> from;
    std::array<double, kFadingLayers> until_s{};
  };
  void Continue(const Shown& before, size_t layer, Quadcode before_node, double now_s, CutNode& node, Shown& shown,
                PageAccess& pages);

  std::unordered_map<Quadcode, Shown> shown_, before_;
  double until_s_ = 0;
  bool waits_ = false;
};

}  // namespace belvedere

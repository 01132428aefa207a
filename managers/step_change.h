// Step change: which step of each layer a view is to show, and which one it goes on showing meanwhile.
//
// When a layer's next step begins, quadnodes change over one by one as its images come (cut.h). Until all have, the
// layer goes on to no other step, however fast the simulation time runs: two steps at most have a part in the picture's
// making, and what time has passed by in between is left out. A change that has come no further for kPatience_s, since
// pages failed or the GPU has no room for both steps, is ended: quadnodes then show the best they have of the new step.
//
// Units: clock seconds; simulation time in seconds since 1970-01-01 UTC. Threads: one an object.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <array>
#include <span>
#include <vector>

namespace belvedere {

class StepChange {
 public:
  static constexpr double kPatience_s = 3.0;

  // The layers of a view as they are to be shown in the list of that time: of a layer with steps, `type` is that of the
  // step. jump: all change at once, for the eye has jumped.
  std::vector<LayerUse> Next(std::span<const LayerUse> layers, const LayerTable& table, double utc_s, double now_s,
                             bool jump);
  // Of each of those layers the step before, or, when it is not changing, the same.
  std::span<const DataType> before() const { return before_; }

  // The list is made; so many images of the step before are in it (Cut::of_step_before).
  void Shown(const std::array<int, kMaxImageLayers>& of_step_before, double now_s);
  // Images of steps before that the last list showed. The next one keeps room for them: while it asks for images of the
  // new steps it does not know yet how many of the old it will show.
  int images_before() const { return images_before_; }
  bool changing() const;
  // Whether another list of these layers would show other steps.
  bool IsDue(std::span<const LayerUse> layers, const LayerTable& table, double utc_s) const;

 private:
  struct Progress {
    int fewest = 0;  // images of the step before that were left, since the change began
    double since_s = 0;
  };

  std::vector<DataType> whole_, now_, before_;  // of each layer: as the view names it, its step, the step before
  std::vector<Progress> progress_;
  int images_before_ = 0;
};

}  // namespace belvedere

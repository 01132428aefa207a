// Held bound: the bound on the screen-space error that keeps a frame-time target, between what was asked and a limit.
//
// A frame that takes too long loosens the bound, one that has time to spare tightens it again, by a step each time the
// render thread has drawn a list made with the bound as it is; so it never reacts to its own past.
//
// Units: pixels, milliseconds. Threads: one an object.
#pragma once

#include "runtime/scene/view_channel.h"

#include <cstdint>

namespace belvedere {

class HeldBound {
 public:
  // The bound to build the next list with. report: of the newest frame; next_list: DisplayList::number of that list.
  // REQUIRES: called once a list.
  double Next(const ViewParameters& view, const FrameReport& report, uint64_t next_list);

 private:
  double loosened_ = 1;           // the bound held over the bound asked
  uint64_t changed_in_list_ = 0;  // the first list built with it
  uint64_t judged_frame_ = 0;
};

}  // namespace belvedere

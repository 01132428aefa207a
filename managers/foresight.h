// Foresight: asks for pages before they are needed. It selects the cut for where the eye will be kAhead_s from now, if
// it goes on as it does (an eye that is tethered to an object goes as the object does), and wishes for what is not in
// memory. Those wishes come after all others: they have kShare of the priority that they will have, and there are none
// while the view that is drawn waits for a page itself. Images come to memory, not to the GPU.
//
// A path that goes down is foreseen as far as half of the height that is left.
//
// Threads: pure but for the pages, which it looks up on the caller's thread.
#pragma once

#include "managers/list_pages.h"

namespace belvedere {

inline constexpr double kAhead_s = 2.0;

// How far ahead of now_s that view is foreseen, seconds; 0: not at all. height_m: of the eye over the ground, now.
double SecondsForeseen(const ViewParameters& view, double now_s, double height_m);

void Foresee(const ViewParameters& view, double now_s, double height_m, const LayerTable& layers, DataType terrain,
             const CutLimits& limits, ListPages& pages);

}  // namespace belvedere

// ViewChannel: where the threads of one view meet: the UI thread, its two managers and the render thread.
//
// Threads: `parameters` is published by the UI thread; each list buffer has its manager as producer and the render
// thread as consumer; `frame` is published by the render thread and read by the UI thread and the managers.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/latest_value.h"
#include "runtime/scene/triple_buffer.h"
#include "runtime/scene/view_parameters.h"

#include <cstdint>

namespace belvedere {

// What the render thread found out while it drew a view.
struct FrameReport {
  uint64_t frame = 0;         // frames drawn of this view so far
  uint64_t terrain_list = 0;  // DisplayList::number that was drawn
  uint64_t object_list = 0;
  double draw_ms = 0;      // the render thread's own work on this view
  double frame_ms = 0;     // from one frame's start to the next
  double busy_ms = 0;      // the render thread's work on the last frame before this, of all views
  uint32_t triangles = 0;  // after culling
  uint32_t nodes = 0;
  uint32_t uploads_pending = 0;  // pages that the newest lists wished on the GPU and that are not there yet
  bool behind = false;
  uint64_t view_number = 0;  // ViewParameters::number that was drawn
  bool settled = false;      // nothing more will come for these parameters
};

struct ViewChannel {
  LatestValue<ViewParameters> parameters;
  TripleBuffer<DisplayList> terrain_lists;
  TripleBuffer<DisplayList> object_lists;
  LatestValue<FrameReport> frame;
};

}  // namespace belvedere

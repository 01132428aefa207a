// FrameRecorder: what every frame cost, for whoever measures. Bounded: when it is full the oldest samples go.
//
// Threads: Add by the render thread, Take by any.
#pragma once

#include "runtime/base/mutex.h"
#include "runtime/base/view_id.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace belvedere {

// One view in one frame.
struct FrameSample {
  ViewId view = 0;
  uint64_t frame = 0;      // number of the render thread's frame, the same for all views drawn in it
  double time_s = 0;       // clock time at its start
  double frame_ms = 0;     // from the start of the frame before to the start of this one
  double draw_ms = 0;      // the render thread's own work on this view
  uint32_t triangles = 0;  // after culling
  uint32_t nodes = 0;
  double held_error_px = 0;  // DisplayList::Statistics
  double achieved_error_px = 0;
  bool behind = false;
  bool has_terrain = false;  // a terrain list was there to draw
  double objects_ms = 0;     // that the newest list of objects took to make
  uint32_t instances = 0;    // in it
  double upload_ms = 0;      // of the frame, all views together; the same number in each of them
  uint64_t upload_bytes = 0;
};

class FrameRecorder {
 public:
  explicit FrameRecorder(size_t capacity) : capacity_(capacity) {}
  void Add(const FrameSample& sample);
  // All samples since the last Take, oldest first.
  std::vector<FrameSample> Take();
  // Samples that were lost because nobody took them.
  uint64_t lost() const;

 private:
  const size_t capacity_;
  mutable Mutex mutex_;
  std::deque<FrameSample> samples_ GUARDED_BY(mutex_);
  uint64_t lost_ GUARDED_BY(mutex_) = 0;
};

}  // namespace belvedere

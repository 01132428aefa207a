// Walks a display list with the render thread's own, newest view, and finds what of it can be seen.
//
// A cull-begin whose volume the frustum or the Earth hides jumps past its cull-end. A volume wholly inside the frustum
// turns the frustum's test off for all that lies in it; the horizon is tested all the way down.
//
// Threads: pure function.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <cstdint>
#include <vector>

namespace belvedere {

struct InstanceRange {
  uint32_t first = 0;
  uint32_t count = 0;
  bool operator==(const InstanceRange&) const = default;
};

struct VisibleDraws {
  std::vector<uint32_t> terrain;  // indices of DisplayList::terrain_draws, in the list's order
  std::vector<InstanceRange> instances;
  uint32_t triangles = 0;  // of the terrain
  void Clear();
};

// Replaces what `visible` held. REQUIRES: records nest, and their indices lie within the list.
void WalkList(const DisplayList& list, const ViewMatrices& matrices, VisibleDraws& visible);

}  // namespace belvedere

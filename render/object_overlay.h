// Symbols and labels of moving objects. Symbols keep their size on the screen and turn with the object's heading;
// labels stand beside the object, and where two would overlap the nearer object keeps its own.
//
// Threads: pure function.
#pragma once

#include "render/moved_objects.h"
#include "render/overlay_pass.h"

#include <cstddef>
#include <span>

namespace belvedere {

inline constexpr size_t kMaxLabels = 300;  // a view; more could not be read

// objects: nearest first, as MoveObjects returns them.
void AddObjectOverlay(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
                      const ViewMatrices& matrices, OverlayBatch& batch);

}  // namespace belvedere

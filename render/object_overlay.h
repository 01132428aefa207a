// Symbols and labels of moving objects. Symbols keep their size on the screen and turn with the object's heading;
// labels stand where the object manager found room for them, joined to the object by a line where they stand off.
//
// Threads: pure function.
#pragma once

#include "render/moved_objects.h"
#include "render/overlay_pass.h"

#include <span>

namespace belvedere {

// objects: nearest first, as MoveObjects returns them.
void AddObjectOverlay(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
                      const ViewMatrices& matrices, OverlayBatch& batch);

}  // namespace belvedere

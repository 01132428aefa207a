#include "runtime/scene/display_list.h"

namespace belvedere {

void DisplayList::Clear() {
  for (Residency* residency : gpu_pins) residency->Unpin();
  gpu_pins.clear();
  page_pins.clear();
  uploads.clear();
  records.clear();
  volumes.clear();
  frames.clear();
  vertices.clear();
  indices.clear();
  terrain_draws.clear();
  instances.clear();
  labels.clear();
  statistics = {};
}

}  // namespace belvedere

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
  if (vertices.use_count() == 1) {
    vertices->clear();
  } else {
    vertices = std::make_shared<std::vector<ListVertex>>();
  }
  indices.clear();
  terrain_draws.clear();
  instances.clear();
  effects.clear();
  labels.clear();
  layer_pages.clear();
  statistics = {};
}

}  // namespace belvedere

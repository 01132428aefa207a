// RenderOptions: what a station may set about drawing.
//
// Threads: values.
#pragma once

#include <cstddef>
#include <string>

namespace belvedere {

struct RenderOptions {
  double max_fps = 60;          // frames are not drawn more often; 0: no limit
  double upload_budget_ms = 4;  // a frame, for all views together; one page is always uploaded
  // Slots of GPU memory: 350 KB a colour page, 87 KB an overlay page.
  int colour_slots = 384;
  int overlay_slots = 480;
  int model_slots = 64;
  int samples = -1;  // of multisampling; -1: none on a software renderer, 4 on a GPU
  std::string font_path = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  size_t recorded_samples = size_t{1} << 14;  // of the recorder, one for each view of a frame
};

}  // namespace belvedere

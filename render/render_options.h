// RenderOptions: what a station may set about drawing.
//
// -1 stands for what suits the renderer: WithDefaults says what that is.
//
// Threads: values.
#pragma once

#include <cstddef>
#include <string>

namespace belvedere {

struct RenderOptions {
  double max_fps = 60;           // frames are not drawn more often; 0: no limit
  double upload_budget_ms = -1;  // a frame, for all views together; one page is always uploaded
  // Slots of GPU memory: 350 KB a colour page, 87 KB an overlay page.
  int colour_slots = -1;
  int overlay_slots = -1;
  int model_slots = 64;
  int samples = -1;  // of multisampling
  std::string font_path = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  size_t recorded_samples = size_t{1} << 14;  // of the recorder, one for each view of a frame
};

// A software renderer: 4 ms of uploads, 384 and 480 slots (168 MiB), no multisampling. A GPU, which may have pictures
// of 8 million pixels to fill: 1 ms of uploads, 768 and 2048 slots (426 MiB). Its samples stay -1 where they are, for
// the renderer to find out what they cost (FrameTarget::SamplesWorthTheirTime).
RenderOptions WithDefaults(RenderOptions options, bool software);

}  // namespace belvedere

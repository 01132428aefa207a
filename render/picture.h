// Picture: one frame of one view, read back, with all that is needed to say what each pixel shows.
//
// Units: depth in metres along the view axis, infinity where there is sky. Rows from the top, left to right.
// Threads: values.
#pragma once

#include "runtime/scene/view_parameters.h"

#include <cstdint>
#include <vector>

namespace belvedere {

struct Picture {
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> rgb;    // 3 a pixel
  std::vector<float> depth_m;  // 1 a pixel
  ViewMatrices matrices;       // with which it was drawn
  uint64_t view_number = 0;    // ViewParameters::number
  uint64_t terrain_list = 0;   // DisplayList::number, 0 none
  uint64_t object_list = 0;
  uint32_t triangles = 0, nodes = 0;
  double achieved_error_px = 0;
  bool settled = false;  // the terrain list that was drawn was, and was made for these parameters
};

}  // namespace belvedere

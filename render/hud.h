// Hud: the few lines in a view's upper left corner that say how it is doing.
//
// Threads: pure functions.
#pragma once

#include "render/overlay_pass.h"

#include <cstdint>
#include <string>
#include <vector>

namespace belvedere {

struct HudFacts {
  double frame_ms = 0;
  double draw_ms = 0;
  double error_asked_px = 0;
  double error_held_px = 0;  // over what was asked only for a frame-time target
  double error_achieved_px = 0;
  uint32_t pages_waiting = 0;
  uint32_t uploads_pending = 0;
  uint32_t triangles = 0;
  uint32_t nodes = 0;
  bool has_terrain = false;
  double latitude_deg = 0, longitude_deg = 0;
  double height_m = 0;  // above the ellipsoid
  double height_above_ground_m = 0;
  std::vector<std::string> notices;  // UTF-8, one line each
};

// Latin-1 lines.
std::vector<std::string> HudLines(const HudFacts& facts);
// "850 m", "12.3 km", "12 346 km"
std::string LengthText(double metres);
void AddHud(const std::vector<std::string>& lines, OverlayBatch& batch);

}  // namespace belvedere

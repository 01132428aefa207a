// Hud: the few lines in a view's upper left corner that say how it is doing.
//
// Threads: pure functions.
#pragma once

#include "render/overlay_pass.h"
#include "runtime/scene/display_list.h"

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
  std::vector<LayerPages> layer_pages;  // one line each
  std::vector<std::string> notices;     // UTF-8, one line each
};

struct HudText {
  std::vector<std::string> lines;  // Latin-1
  size_t first_notice = 0;         // lines from there on are notices
};
HudText HudTextOf(const HudFacts& facts);
// "850 m", "12.3 km", "12 346 km"
std::string LengthText(double metres);
void AddHud(const HudText& text, OverlayBatch& batch);

}  // namespace belvedere

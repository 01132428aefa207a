#include "render/hud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr size_t kMostNotices = 4;
constexpr size_t kLongestNotice = 110;
constexpr OverlayBatch::Colour kText = {236, 240, 244, 255};
constexpr OverlayBatch::Colour kNotice = {255, 196, 110, 255};
constexpr OverlayBatch::Colour kBackground = {10, 16, 26, 130};

}  // namespace

std::string LengthText(double metres) {
  const double size = std::abs(metres);
  if (size < 10) return fmt::format("{:.2f} m", metres);
  if (size < 10'000) return fmt::format("{:.0f} m", metres);
  if (size < 1e6) return fmt::format("{:.1f} km", metres / 1000);
  const long kilometres = std::lround(metres / 1000);
  return fmt::format("{} {:03} km", kilometres / 1000, std::abs(kilometres % 1000));
}

namespace {

std::string ErrorText(const HudFacts& facts) {
  // Where the bound asked costs too much, what is held in its place.
  const bool loosened = facts.error_held_px > facts.error_asked_px * 1.01;
  return loosened
             ? fmt::format("error {:.1f} px asked, holding {:.1f}", facts.error_asked_px, facts.error_held_px)
             : fmt::format("error {:.1f} px asked, {:.1f} achieved", facts.error_asked_px, facts.error_achieved_px);
}

std::string PagesText(const LayerPages& pages) {
  std::string text = pages.layer + ":";
  const auto add = [&](uint32_t count, const char* where) {
    if (count > 0) text += fmt::format("   {} {}", count, where);
  };
  add(pages.on_gpu, "on the GPU");
  add(pages.in_memory, "in memory");
  add(pages.asked, "asked for");
  add(pages.failed, "failed");
  return text;
}

}  // namespace

HudText HudTextOf(const HudFacts& facts) {
  HudText text;
  std::vector<std::string>& lines = text.lines;
  const double fps = facts.frame_ms > 0 ? 1000.0 / facts.frame_ms : 0;
  lines.push_back(
      fmt::format("{:.0f} frames/s   frame {:.1f} ms   draw {:.1f} ms", fps, facts.frame_ms, facts.draw_ms));
  lines.push_back(facts.has_terrain ? fmt::format("{}   {} pages waiting", ErrorText(facts),
                                                  facts.pages_waiting + facts.uploads_pending)
                                    : std::string("waiting for the first surface"));
  lines.push_back(fmt::format("{} triangles   {} quadnodes", facts.triangles, facts.nodes));
  lines.push_back(ToLatin1(fmt::format("{:.4f}° {}  {:.4f}° {}   height {}   over ground {}",
                                       std::abs(facts.latitude_deg), facts.latitude_deg < 0 ? 'S' : 'N',
                                       std::abs(facts.longitude_deg), facts.longitude_deg < 0 ? 'W' : 'E',
                                       LengthText(facts.height_m), LengthText(facts.height_above_ground_m))));
  for (const LayerPages& pages : facts.layer_pages)
    lines.push_back(ToLatin1(PagesText(pages)).substr(0, kLongestNotice));
  text.first_notice = lines.size();
  for (size_t i = 0; i < std::min(facts.notices.size(), kMostNotices); ++i) {
    lines.push_back(ToLatin1(facts.notices[i]).substr(0, kLongestNotice));
  }
  return text;
}

void AddHud(const HudText& text, OverlayBatch& batch) {
  constexpr float kMargin = 6;
  float width = 0;
  for (const std::string& line : text.lines) width = std::max(width, batch.atlas().WidthOf(line));
  const float height = Atlas::kLineHeight_px * static_cast<float>(text.lines.size());
  batch.AddRectangle(kMargin, kMargin, width + 2 * kMargin, height + 2 * kMargin, kFrontDepth, kBackground);
  float baseline = 2 * kMargin + Atlas::kFontHeight_px;
  for (size_t i = 0; i < text.lines.size(); ++i) {
    batch.AddText(2 * kMargin, baseline, kFrontDepth, text.lines[i], i < text.first_notice ? kText : kNotice);
    baseline += Atlas::kLineHeight_px;
  }
}

}  // namespace belvedere

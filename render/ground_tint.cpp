#include "render/ground_tint.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr float kStrength = 0.75F;
constexpr double kGoldenRatio = 0.6180339887498949;  // hues this far apart are never alike

uint32_t Pack(const glm::vec3& rgb, float alpha) {
  const auto byte = [](float x) { return static_cast<uint32_t>(std::lround(std::clamp(x, 0.0F, 1.0F) * 255.0F)); };
  return byte(rgb.r) | byte(rgb.g) << 8U | byte(rgb.b) << 16U | byte(alpha) << 24U;
}

// hue: in turns.
glm::vec3 Hue(double hue) {
  const auto h = static_cast<float>(6.0 * (hue - std::floor(hue)));
  return glm::clamp(glm::vec3(std::abs(h - 3.0F) - 1.0F, 2.0F - std::abs(h - 2.0F), 2.0F - std::abs(h - 4.0F)), 0.0F,
                    1.0F);
}

// Neighbours of one level differ in brightness.
uint32_t LevelColour(Quadcode node) {
  const bool light = ((node.column() + node.row()) & 1) == 0;
  return Pack(Hue(kGoldenRatio * node.level()) * (light ? 1.0F : 0.7F), kStrength);
}

uint32_t ImageColour(const TerrainDraw& draw) {
  if (draw.images[0].slot < 0) return Pack(glm::vec3(0.5F), kStrength);
  return LevelColour(draw.images[0].source);
}

}  // namespace

uint32_t ErrorColour(double error_px, double bound_px) {
  const double share = bound_px > 0 ? std::clamp(error_px / bound_px, 0.0, 1.5) : 0.0;
  constexpr double kBlue = 2.0 / 3.0, kYellow = 1.0 / 6.0;
  const double hue = share <= 1.0 ? kBlue + (kYellow - kBlue) * share : kYellow * (1.5 - share) / 0.5;
  return Pack(Hue(hue), kStrength);
}

std::array<uint32_t, kGroundTints - 1> TintsOf(const TerrainDraw& draw, const DisplayList& list) {
  const double frame_hue = kGoldenRatio * static_cast<double>(draw.frame);
  return {ErrorColour(draw.error_px, list.statistics.held_error_px), LevelColour(draw.node),
          Pack(Hue(frame_hue), kStrength), ImageColour(draw)};
}

}  // namespace belvedere

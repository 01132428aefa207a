#include "servers/slope_tint.h"

#include "runtime/earth/post_grid.h"
#include "runtime/earth/units.h"
#include "servers/mip_levels.h"
#include "servers/texel_heights.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere {
namespace {

using Colour = std::array<uint8_t, 4>;

struct Stop {
  double steepness_deg;
  std::array<double, 3> colour;
};
constexpr std::array<Stop, 6> kRamp = {{{0, {226, 232, 220}},
                                        {5, {150, 200, 115}},
                                        {10, {245, 228, 100}},
                                        {20, {240, 150, 48}},
                                        {30, {208, 50, 40}},
                                        {40, {92, 18, 70}}}};

Colour ColourOf(double steepness_deg) {
  size_t next = 1;
  while (next + 1 < kRamp.size() && kRamp[next].steepness_deg < steepness_deg) ++next;
  const Stop& low = kRamp[next - 1];
  const Stop& high = kRamp[next];
  const double share =
      std::clamp((steepness_deg - low.steepness_deg) / (high.steepness_deg - low.steepness_deg), 0.0, 1.0);
  Colour colour{0, 0, 0, 255};
  for (size_t i = 0; i < 3; ++i) {
    colour[i] = static_cast<uint8_t>(std::lround(low.colour[i] + share * (high.colour[i] - low.colour[i])));
  }
  return colour;
}

// Colours by rise over run: kEntries over the rises of 0 .. 1.
constexpr int kEntries = 2048;
std::array<Colour, kEntries> ColoursByRise() {
  std::array<Colour, kEntries> colours;
  for (size_t i = 0; i < colours.size(); ++i) {
    colours[i] = ColourOf(std::atan(static_cast<double>(i) / kEntries) * kDegreesPerRadian);
  }
  return colours;
}

}  // namespace

std::unique_ptr<ImagePage> TintSlopes(const ElevationPage& heights, Quadcode node) {
  static const std::array<Colour, kEntries> kColours = ColoursByRise();
  const std::vector<TexelHeight> ground = HeightsAtTexels(heights, node, nullptr);
  auto page = std::make_unique<ImagePage>();
  page->texels.resize(ImagePage::MipOffset(kImageMipLevels, page->format));
  const double step_deg = node.HeightDegrees() / kCells;
  const TexelHeight* at = ground.data();
  uint8_t* texel = page->texels.data();
  for (int row = 0; row < kImageSide; ++row) {
    const double posts = (row - kImageGutter + 0.5) * kPostsPerTexel;
    const RowGeometry geometry = RowAt(std::clamp(node.Box().south_deg + posts * step_deg, -90.0, 90.0));
    // Towards a pole posts crowd; their slopes along the parallel would be noise.
    const double cos_latitude = std::max(geometry.cos_latitude, 0.02);
    const double step_radians = step_deg * kRadiansPerDegree;
    const double step_east_radians = node.WidthDegrees() / kCells * kRadiansPerDegree;
    const auto per_east_m = static_cast<float>(1 / (step_east_radians * geometry.prime_vertical_m * cos_latitude));
    const auto per_north_m = static_cast<float>(1 / (step_radians * geometry.meridian_m));
    for (int column = 0; column < kImageSide; ++column, ++at) {
      const float east = at->rise_east_m * per_east_m;
      const float north = at->rise_north_m * per_north_m;
      const float entry = std::sqrt(east * east + north * north) * kEntries;
      texel = std::ranges::copy(kColours[static_cast<size_t>(std::min(entry, kEntries - 1.0F))], texel).out;
    }
  }
  FillMipLevels(*page);
  return page;
}

}  // namespace belvedere

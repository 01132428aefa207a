// Elevation pages made of a formula, for tests of what is built from heights.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/paging/page.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

namespace belvedere {

// Height in metres at a grid point; the same point has the same height in every page, so borders and aprons agree.
using HeightFormula = std::function<double(GridPoint)>;

// A rough surface: grid points are hashed at several spacings and interpolated by smooth waves instead of noise, so
// that it is the same on every machine.
inline double WavyHeight(GridPoint point) {
  const double lon = point.longitude_deg();
  const double lat = point.latitude_deg();
  // Smooth across 180 E, and one value at each pole.
  const double narrowing = std::cos(lat * 0.017453292519943295);
  const double wave = std::sin(lon * 0.017453292519943295 * 8) + std::sin(lon * 0.017453292519943295 * 360) * 0.3 +
                      std::sin(lon * 0.017453292519943295 * 3600 + lat) * 0.1;
  return 1500 + 900 * narrowing * wave + 400 * std::sin(lat * 1.3) + 35 * std::sin(lat * 300);
}

inline std::unique_ptr<ElevationPage> MakeElevation(Quadcode node, const HeightFormula& height_m) {
  auto page = std::make_unique<ElevationPage>();
  page->heights_mm.resize(static_cast<size_t>(kElevationSide) * kElevationSide);
  const GridPoint corner = node.SouthWest();
  const auto east = static_cast<int64_t>(node.PostSpacingEast()), north = static_cast<int64_t>(node.PostSpacingNorth());
  int32_t least = INT32_MAX;
  int32_t greatest = INT32_MIN;
  size_t index = 0;
  for (int row = -kApron; row < kPosts + kApron; ++row) {
    for (int column = -kApron; column < kPosts + kApron; ++column) {
      const int64_t y = std::clamp<int64_t>(corner.y + row * north, 0, kGridNorthPole);
      const GridPoint point{static_cast<uint32_t>(corner.x + column * east), static_cast<uint32_t>(y)};
      const bool at_pole = y == 0 || y == kGridNorthPole;
      const auto height_mm = static_cast<int32_t>(std::lround(1e3 * height_m(at_pole ? GridPoint{0, point.y} : point)));
      page->heights_mm[index++] = height_mm;
      if (row < 0 || row >= kPosts || column < 0 || column >= kPosts) continue;
      least = std::min(least, height_mm);
      greatest = std::max(greatest, height_mm);
    }
  }
  page->min_m = static_cast<float>(least) * 1e-3F;
  page->max_m = static_cast<float>(greatest) * 1e-3F;
  return page;
}

}  // namespace belvedere

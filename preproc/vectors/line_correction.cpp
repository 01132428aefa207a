#include "preproc/vectors/line_correction.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/units.h"
#include "runtime/paging/page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace belvedere {
namespace {

constexpr int kCellLog2 = 18;     // of grid units: 0.022 degrees
constexpr int kSmoothedOver = 4;  // heights on each side
constexpr double kUnitsPerDegree = (1 << kGridBitsPerTree) / kTreeDegrees;
// The Earth's mean radius will do for widths.
constexpr double kMetresPerUnit = kEquatorialRadius_m * kRadiansPerDegree / kUnitsPerDegree;

double LatitudeOf(int64_t y) {
  return static_cast<double>(y) / kUnitsPerDegree - 90;
}
// How many metres a grid unit is to the east.
double MetresEast(int64_t y) {
  constexpr double kNarrowest = 1e-3;  // beside a pole
  return kMetresPerUnit * std::max(std::cos(LatitudeOf(y) * kRadiansPerDegree), kNarrowest);
}

uint64_t CellOf(int64_t column, int64_t row) {
  constexpr int64_t kColumns = int64_t{1} << (32 - kCellLog2);
  return static_cast<uint64_t>(((column % kColumns) + kColumns) % kColumns) << 32 | static_cast<uint32_t>(row);
}

// Points along the line, no further apart than so many metres; the line's own among them.
FeaturePart Divided(const FeaturePart& line, double distance_m) {
  FeaturePart out{line.front()};
  for (size_t i = 1; i < line.size(); ++i) {
    const GridPlace a = line[i - 1], b = line[i];
    const double length_m =
        std::hypot(static_cast<double>(b.x - a.x) * MetresEast(a.y), static_cast<double>(b.y - a.y) * kMetresPerUnit);
    const auto steps = static_cast<int64_t>(std::max(1.0, std::ceil(length_m / distance_m)));
    for (int64_t step = 1; step <= steps; ++step)
      out.push_back({a.x + (b.x - a.x) * step / steps, a.y + (b.y - a.y) * step / steps});
  }
  return out;
}

// The ends stay; a height further in is the mean of as many on each side as there are up to the nearer end.
std::vector<double> Smoothed(const std::vector<double>& heights_m) {
  std::vector<double> out;
  out.reserve(heights_m.size());
  for (size_t i = 0; i < heights_m.size(); ++i) {
    const size_t reach = std::min({i, heights_m.size() - 1 - i, size_t{kSmoothedOver}});
    double sum = 0;
    for (size_t at = i - reach; at <= i + reach; ++at) sum += heights_m[at];
    out.push_back(sum / static_cast<double>(2 * reach + 1));
  }
  return out;
}

std::vector<double> Falling(std::vector<double> heights_m) {
  const bool is_upstream = heights_m.back() > heights_m.front();
  if (is_upstream) std::reverse(heights_m.begin(), heights_m.end());
  for (size_t i = 1; i < heights_m.size(); ++i) heights_m[i] = std::min(heights_m[i], heights_m[i - 1]);
  if (is_upstream) std::reverse(heights_m.begin(), heights_m.end());
  return heights_m;
}

// 1 up to half a width from the line, 0 from a whole one on.
double ShareAt(double distance_m, double width_m) {
  const double t = std::clamp(2 * distance_m / width_m - 1, 0.0, 1.0);
  return 1 - t * t * (3 - 2 * t);
}

}  // namespace

void LineCorrection::Add(std::span<const Feature> features, double width_m, const Ground& ground) {
  for (const Feature& feature : features) {
    if (feature.shape != FeatureShape::kLines) continue;
    for (const FeaturePart& line : feature.parts) AddLine(line, feature.of == FeatureClass::kRiver, width_m, ground);
  }
}

void LineCorrection::AddLine(const FeaturePart& line, bool falls, double width_m, const Ground& ground) {
  widest_m_ = std::max(widest_m_, width_m);
  const FeaturePart places = Divided(line, width_m);
  std::vector<double> heights_m;
  heights_m.reserve(places.size());
  for (const GridPlace& place : places) {
    const GridPoint point{static_cast<uint32_t>(place.x), static_cast<uint32_t>(place.y)};
    heights_m.push_back(ground(point.latitude_deg(), point.longitude_deg()));
  }
  heights_m = falls ? Falling(std::move(heights_m)) : Smoothed(heights_m);
  for (size_t i = 1; i < places.size(); ++i) {
    segments_.push_back({places[i - 1], places[i], heights_m[i - 1], heights_m[i], width_m});
    Index(segments_.size() - 1);
  }
}

void LineCorrection::Index(size_t segment) {
  const auto& [a, b, a_m, b_m, width_m] = segments_[segment];
  const auto reach_x = static_cast<int64_t>(width_m / std::min(MetresEast(a.y), MetresEast(b.y))) + 1;
  const auto reach_y = static_cast<int64_t>(width_m / kMetresPerUnit) + 1;
  for (int64_t row = (std::min(a.y, b.y) - reach_y) >> kCellLog2; row <= (std::max(a.y, b.y) + reach_y) >> kCellLog2;
       ++row) {
    for (int64_t column = (std::min(a.x, b.x) - reach_x) >> kCellLog2;
         column <= (std::max(a.x, b.x) + reach_x) >> kCellLog2; ++column)
      cells_[CellOf(column, row)].push_back(static_cast<uint32_t>(segment));
  }
}

void LineCorrection::Apply(Quadcode node, std::vector<int32_t>& heights_mm) const {
  const int64_t spacing = node.PostSpacing();
  if (empty() || static_cast<double>(spacing) * kMetresPerUnit > widest_m_) return;
  const int64_t west = int64_t{node.SouthWest().x} - kApron * spacing,
                south = int64_t{node.SouthWest().y} - kApron * spacing;
  const int64_t side = (kElevationSide - 1) * spacing;
  std::vector<uint32_t> near;
  for (int64_t row = south >> kCellLog2; row <= (south + side) >> kCellLog2; ++row) {
    for (int64_t column = west >> kCellLog2; column <= (west + side) >> kCellLog2; ++column) {
      const auto cell = cells_.find(CellOf(column, row));
      if (cell != cells_.end()) near.insert(near.end(), cell->second.begin(), cell->second.end());
    }
  }
  // In their order, so that of two that are as near the same one counts in every page.
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::vector<double> distances_m(heights_mm.size(), std::numeric_limits<double>::infinity());
  std::vector<std::pair<double, double>> lines(heights_mm.size());  // height and share of the nearest
  for (const uint32_t number : near) {
    const auto& [a, b, a_m, b_m, width_m] = segments_[number];
    if (static_cast<double>(spacing) * kMetresPerUnit > width_m) continue;
    const auto reach_y = static_cast<int64_t>(width_m / kMetresPerUnit) + 1;
    const int64_t first = std::max<int64_t>((std::min(a.y, b.y) - reach_y - south) / spacing, 0);
    const int64_t last = std::min<int64_t>((std::max(a.y, b.y) + reach_y - south) / spacing, kElevationSide - 1);
    for (int64_t row = first; row <= last; ++row) {
      const int64_t y = south + row * spacing;
      if (y < 0 || y > int64_t{kGridNorthPole}) continue;
      const double east_m = MetresEast(y);
      const double along_x = static_cast<double>(b.x - a.x) * east_m,
                   along_y = static_cast<double>(b.y - a.y) * kMetresPerUnit;
      const double squared = along_x * along_x + along_y * along_y;
      for (int64_t column = 0; column < kElevationSide; ++column) {
        // The short way round the Earth.
        const auto offset = static_cast<int32_t>(static_cast<uint32_t>(west + column * spacing - a.x));
        const double x = offset * east_m, z = static_cast<double>(y - a.y) * kMetresPerUnit;
        const double t = squared > 0 ? std::clamp((x * along_x + z * along_y) / squared, 0.0, 1.0) : 0.0;
        const double distance_m = std::hypot(x - t * along_x, z - t * along_y);
        const auto at = static_cast<size_t>(row * kElevationSide + column);
        if (distance_m >= width_m || distance_m >= distances_m[at]) continue;
        distances_m[at] = distance_m;
        lines[at] = {a_m + t * (b_m - a_m), ShareAt(distance_m, width_m)};
      }
    }
  }
  for (size_t at = 0; at < heights_mm.size(); ++at) {
    const auto& [height_m, share] = lines[at];
    if (share <= 0) continue;
    const double was_m = heights_mm[at] * kMetresPerMillimetre;
    heights_mm[at] = static_cast<int32_t>(std::lrint((was_m + share * (height_m - was_m)) / kMetresPerMillimetre));
  }
}

}  // namespace belvedere

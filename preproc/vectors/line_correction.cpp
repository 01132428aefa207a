#include "preproc/vectors/line_correction.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/page.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace belvedere {
namespace {

constexpr int kCellLog2 = 18;     // of grid units: 0.022 degrees
constexpr int kSmoothedOver = 4;  // heights on each side

// Metres of a grid unit east and north; beside a pole, where none is left east, a little of one.
glm::dvec2 MetresPerUnit(int64_t y) {
  constexpr double kNearPole_deg = 89.9;
  return MetresPerDegree(std::clamp(GridPlace{0, y}.latitude_deg(), -kNearPole_deg, kNearPole_deg)) / kUnitsPerDegree;
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
    const double length_m = glm::length(MetresPerUnit(a.y) * glm::dvec2(b.x - a.x, b.y - a.y));
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
    const GridPoint point{static_cast<uint32_t>(place.x), static_cast<uint32_t>(place.y)};  // of its own turn
    heights_m.push_back(ground(point.latitude_deg(), point.longitude_deg()));
  }
  heights_m = falls ? Falling(std::move(heights_m)) : Smoothed(heights_m);
  for (size_t i = 1; i < places.size(); ++i) {
    segments_.push_back({places[i - 1], places[i], heights_m[i - 1], heights_m[i], width_m});
    Index(segments_.size() - 1);
  }
}

GridExtent LineCorrection::ReachOf(const Segment& segment) {
  const auto& [a, b, a_m, b_m, width_m] = segment;
  const glm::dvec2 metres = glm::min(MetresPerUnit(a.y), MetresPerUnit(b.y));
  const auto x = static_cast<int64_t>(width_m / metres.x) + 1, y = static_cast<int64_t>(width_m / metres.y) + 1;
  return {std::min(a.x, b.x) - x, std::min(a.y, b.y) - y, std::max(a.x, b.x) + x, std::max(a.y, b.y) + y};
}

void LineCorrection::Index(size_t segment) {
  const GridExtent reach = ReachOf(segments_[segment]);
  for (int64_t row = reach.south >> kCellLog2; row <= reach.north >> kCellLog2; ++row) {
    for (int64_t column = reach.west >> kCellLog2; column <= reach.east >> kCellLog2; ++column)
      cells_[CellOf(column, row)].push_back(static_cast<uint32_t>(segment));
  }
}

// In their order, so that of two that are as near the same one counts in every page.
std::vector<uint32_t> LineCorrection::SegmentsNear(const PostRaster& posts) const {
  constexpr int64_t kSteps = kElevationSide - 1;
  const int64_t east = posts.west + kSteps * posts.east_spacing, north = posts.south + kSteps * posts.north_spacing;
  std::vector<uint32_t> near;
  for (int64_t row = posts.south >> kCellLog2; row <= north >> kCellLog2; ++row) {
    for (int64_t column = posts.west >> kCellLog2; column <= east >> kCellLog2; ++column) {
      const auto cell = cells_.find(CellOf(column, row));
      if (cell != cells_.end()) near.insert(near.end(), cell->second.begin(), cell->second.end());
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

void LineCorrection::Reach(const Segment& segment, const PostRaster& posts, std::vector<Nearest>& nearest) {
  const auto& [a, b, a_m, b_m, width_m] = segment;
  const GridExtent reach = ReachOf(segment);
  // The short way round the Earth.
  const int64_t turn = (posts.west - a.x + kUnitsAround / 2) >> 32;
  const int64_t west = posts.west - turn * kUnitsAround;
  const auto first = [](int64_t offset, int64_t spacing) { return std::max<int64_t>(offset / spacing, 0); };
  const auto last = [](int64_t offset, int64_t spacing) {
    return std::min<int64_t>(offset / spacing, kElevationSide - 1);
  };
  const int64_t first_column = first(reach.west - west, posts.east_spacing);
  const int64_t last_column = last(reach.east - west, posts.east_spacing);
  const int64_t last_row = last(reach.north - posts.south, posts.north_spacing);
  for (int64_t row = first(reach.south - posts.south, posts.north_spacing); row <= last_row; ++row) {
    const int64_t y = posts.south + row * posts.north_spacing;
    if (y < 0 || y > int64_t{kGridNorthPole}) continue;
    const glm::dvec2 metres = MetresPerUnit(y);
    const glm::dvec2 along = metres * glm::dvec2(b.x - a.x, b.y - a.y);
    const double squared = glm::dot(along, along);
    for (int64_t column = first_column; column <= last_column; ++column) {
      const glm::dvec2 at = metres * glm::dvec2(west + column * posts.east_spacing - a.x, y - a.y);
      const double t = squared > 0 ? std::clamp(glm::dot(at, along) / squared, 0.0, 1.0) : 0.0;
      const double distance_m = glm::distance(at, t * along);
      Nearest& post = nearest[static_cast<size_t>(row * kElevationSide + column)];
      if (distance_m < width_m && distance_m < post.distance_m)
        post = {distance_m, a_m + t * (b_m - a_m), ShareAt(distance_m, width_m)};
    }
  }
}

void LineCorrection::Apply(Quadcode node, std::vector<int32_t>& heights_mm) const {
  const int64_t east = node.PostSpacingEast(), north = node.PostSpacingNorth();
  // As at the equator, so that all pages of a level are corrected by the same lines.
  const double spacing_m = static_cast<double>(north) * MetresPerDegree(0).y / kUnitsPerDegree;
  if (empty() || spacing_m > widest_m_) return;
  const PostRaster posts{int64_t{node.SouthWest().x} - kApron * east, int64_t{node.SouthWest().y} - kApron * north,
                         east, north};
  std::vector<Nearest> nearest(heights_mm.size());
  for (const uint32_t number : SegmentsNear(posts)) {
    if (spacing_m <= segments_[number].width_m) Reach(segments_[number], posts, nearest);
  }
  for (size_t at = 0; at < heights_mm.size(); ++at) {
    const auto& [distance_m, height_m, share] = nearest[at];
    if (share <= 0) continue;
    const double was_m = heights_mm[at] * kMetresPerMillimetre;
    heights_mm[at] = static_cast<int32_t>(std::lrint((was_m + share * (height_m - was_m)) / kMetresPerMillimetre));
  }
}

}  // namespace belvedere

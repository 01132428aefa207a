// Feature: a road, a river, a place, a building, as read from a source, whole and on the Earth's grid.
//
// Coordinates are grid units (quadcode.h) counted on beyond 180 E and 180 W, so that a line that crosses 180 has no
// jump; y from 90 S.
// Threads: values; pure functions.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/paging/vector_page.h"

#include <compare>
#include <cstdint>
#include <vector>

namespace belvedere {

inline constexpr double kUnitsPerDegree = (1 << kGridBitsPerTree) / kTreeDegrees;
inline constexpr int64_t kUnitsAround = int64_t{1} << 32;  // the Earth

struct GridPlace {
  int64_t x = 0, y = 0;
  auto operator<=>(const GridPlace&) const = default;

  // The nearest to a position, whatever its turn.
  static GridPlace At(double latitude_deg, double longitude_deg);
  double longitude_deg() const { return static_cast<double>(x) / kUnitsPerDegree - 180; }  // of any turn
  double latitude_deg() const { return static_cast<double>(y) / kUnitsPerDegree - 90; }
};
using FeaturePart = std::vector<GridPlace>;
using FeatureParts = std::vector<FeaturePart>;

struct GridExtent {
  int64_t west = INT64_MAX, south = INT64_MAX, east = INT64_MIN, north = INT64_MIN;
  void Add(const FeatureParts& parts);
  int64_t size() const;  // the longer side
  GridPlace middle() const;
  GeoBox box() const;  // over 180 E east is more than 180
};

struct Feature {
  uint32_t id = 0;
  FeatureClass of = FeatureClass::kOther;
  FeatureShape shape = FeatureShape::kPoints;
  // Where not all fit a page, those with more come first.
  double importance = 0;
  double resolution = 0;  // grid units that its points may be off by where it is shown finest
  // As in VectorPage: of points one part; of polygons rings, open and even-odd.
  FeatureParts parts;
  std::vector<Attribute> attributes;
};

}  // namespace belvedere

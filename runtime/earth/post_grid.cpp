#include "runtime/earth/post_grid.h"

#include "runtime/base/status.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/units.h"

#include <algorithm>
#include <cmath>

namespace belvedere {

RowGeometry RowAt(double latitude_deg) {
  const double latitude = latitude_deg * kRadiansPerDegree;
  RowGeometry row;
  row.sin_latitude = std::sin(latitude);
  row.cos_latitude = std::abs(latitude_deg) == 90.0 ? 0.0 : std::cos(latitude);
  const double squared = 1.0 - kEccentricitySquared * row.sin_latitude * row.sin_latitude;
  row.prime_vertical_m = kEquatorialRadius_m / std::sqrt(squared);
  row.meridian_m = row.prime_vertical_m * (1.0 - kEccentricitySquared) / squared;
  return row;
}

glm::dvec3 EcefAt(const RowGeometry& row, const ColumnGeometry& column, double height_m) {
  const double horizontal = (row.prime_vertical_m + height_m) * row.cos_latitude;
  return {horizontal * column.cos_longitude, horizontal * column.sin_longitude,
          (row.prime_vertical_m * (1.0 - kEccentricitySquared) + height_m) * row.sin_latitude};
}

PostGrid::PostGrid(Quadcode node, int per_cell) {
  const auto parts = static_cast<uint32_t>(per_cell);
  BELVEDERE_CHECK(per_cell > 0 && parts <= node.PostSpacingNorth());
  const uint32_t east = node.PostSpacingEast() / parts, north = node.PostSpacingNorth() / parts;
  const int points = kCells * per_cell + 1;
  rows.reserve(static_cast<size_t>(points));
  columns.reserve(static_cast<size_t>(points));
  GridPoint point = node.SouthWest();
  for (int i = 0; i < points; ++i) {
    rows.push_back(RowAt(point.latitude_deg()));
    const double longitude = point.longitude_deg() * kRadiansPerDegree;
    columns.push_back({std::sin(longitude), std::cos(longitude)});
    point.x += east;  // wraps at 180 E, where 180 W has the same bits
    point.y += north;
  }
}

double WidthOnGroundDegrees(Quadcode node) {
  const GeoBox box = node.Box();
  const double nearest_equator_deg = std::min(std::abs(box.south_deg), std::abs(box.north_deg));
  return node.WidthDegrees() * std::cos(nearest_equator_deg * kRadiansPerDegree);
}

double CellSagitta(Quadcode node) {
  constexpr double kMetresPerDegree = kEquatorialRadius_m * kRadiansPerDegree;
  const double north_m = node.HeightDegrees() / kCells * kMetresPerDegree;
  const double east_m = WidthOnGroundDegrees(node) / kCells * kMetresPerDegree;
  return (north_m * north_m + east_m * east_m) / (8.0 * kPolarRadius_m);
}

}  // namespace belvedere

#include "runtime/paging/roundness.h"

#include "runtime/earth/units.h"
#include "runtime/paging/delta_values.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace belvedere {
namespace {

constexpr int kPerCell = FinestSurface::kPerCell;
constexpr int kSamples = 4;  // along a leg: all that is looked at is nearly quadratic

// Where a post's point is among those of FinestSurface.
Post PointOf(Post post) {
  return {post.column * kPerCell, post.row * kPerCell};
}

}  // namespace

Paraboloid::Paraboloid(Quadcode node) {
  const GeoBox box = node.Box();
  const RowGeometry row = RowAt(0.5 * (box.south_deg + box.north_deg));
  const double east = node.WidthDegrees() / (kCells * kPerCell) * kRadiansPerDegree;
  const double north = node.HeightDegrees() / (kCells * kPerCell) * kRadiansPerDegree;
  per_column_m_ = 0.5 * row.prime_vertical_m * row.cos_latitude * row.cos_latitude * east * east;
  per_row_m_ = 0.5 * row.meridian_m * north * north;
  constexpr int kLast = FinestSurface::kSide - 1;
  if (node.touches_north_pole() || node.touches_south_pole()) {
    first_wide_row_ = node.is_root() && node.touches_north_pole() ? kLast / 2 + 1 : 0;
    last_wide_row_ = node.is_root() && node.touches_south_pole() ? kLast / 2 - 1 : kLast;
  }
}

double Paraboloid::At(int column, int row) const {
  if (!IsHalfWay(column, row)) return OnEllipsoid(column, row);
  return 0.5 * (OnEllipsoid(column - 1, row) + OnEllipsoid(column + 1, row));
}

double Paraboloid::OnEllipsoid(int column, int row) const {
  constexpr int kMiddle = kCells * kPerCell / 2;
  const double x = column - kMiddle, y = row - kMiddle;
  return -per_column_m_ * x * x - per_row_m_ * y * y;
}

Roundness::Roundness(Quadcode node, const Paraboloid& paraboloid) : grid_(node, kPerCell), paraboloid_(paraboloid) {
  for (int level = 0; level < kBisectionLevels; ++level) {
    const int most_column = 3 * HalfSpan(level);  // as many posts of a row as there are ways for hypotenuses to run
    ForEachPost(level, [&](Post post) {
      if (post.column > most_column) return;
      const Split split = SplitAt(post);
      for (const Post apex : {split.apex_a, split.apex_b}) {
        if (apex.inside()) Widen(apex, split, rests_[static_cast<size_t>(level)][static_cast<size_t>(post.row)]);
      }
    });
  }
}

Roundness::Place Roundness::At(Post point) const {
  const auto ecef = [&](int column) {
    return grid_.At(static_cast<size_t>(column), static_cast<size_t>(point.row), 0);
  };
  const glm::dvec3 here = paraboloid_.IsHalfWay(point.column, point.row)
                              ? 0.5 * (ecef(point.column - 1) + ecef(point.column + 1))
                              : ecef(point.column);
  return {here, paraboloid_.At(point.column, point.row)};
}

void Roundness::Widen(Post apex, const Split& split, Rest& rest) const {
  const Post a = PointOf(apex), b = PointOf(split.end_a), c = PointOf(split.end_b);
  const Place at_a = At(a), at_b = At(b), at_c = At(c);
  const auto [west, east] = std::minmax({a.column, b.column, c.column});
  const auto [south, north] = std::minmax({a.row, b.row, c.row});
  const int step = std::max(1, std::min(east - west, north - south) / kSamples);
  const double area = (b.column - a.column) * (c.row - a.row) - (c.column - a.column) * (b.row - a.row);
  for (int row = south; row <= north; row += step) {
    for (int column = west; column <= east; column += step) {
      // Shares of the corners.
      const double u = ((column - a.column) * (c.row - a.row) - (c.column - a.column) * (row - a.row)) / area;
      const double v = ((b.column - a.column) * (row - a.row) - (column - a.column) * (b.row - a.row)) / area;
      const double w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      const Place here = At({column, row});
      const glm::dvec3 off = here.ecef - (w * at_a.ecef + u * at_b.ecef + v * at_c.ecef);
      const double known_m =
          here.paraboloid_m - (w * at_a.paraboloid_m + u * at_b.paraboloid_m + v * at_c.paraboloid_m);
      const glm::dvec3 up = grid_.UpAt(static_cast<size_t>(column), static_cast<size_t>(row));
      const double up_m = glm::dot(off, up);
      rest.up_m = std::max(rest.up_m, std::abs(up_m - known_m));
      rest.aside_m = std::max(rest.aside_m, glm::length(off - up_m * up));
    }
  }
}

const Roundness& RoundnessAround(Quadcode node) {
  constexpr size_t kKept = 64;  // 30 KB each
  struct Kept {
    Quadcode node;
    std::unique_ptr<const Roundness> roundness;
  };
  thread_local std::array<Kept, kKept> kept;
  // Rows next to each other and levels over each other have places of their own.
  constexpr int64_t kRowsOfALevel = 11;
  Kept& place = kept[static_cast<size_t>(node.row() + kRowsOfALevel * node.level()) % kKept];
  const Quadcode first = Quadcode::FromColumnRow(node.level(), 0, node.row());
  if (place.roundness == nullptr || place.node != first) {
    place.roundness = std::make_unique<const Roundness>(first, Paraboloid(first));
    place.node = first;
  }
  return *place.roundness;
}

}  // namespace belvedere

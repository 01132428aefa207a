#include "servers/height_field.h"

#include "runtime/base/status.h"
#include "runtime/earth/post_grid.h"
#include "runtime/earth/units.h"

#include <cmath>

namespace belvedere {
namespace {

double Mix(double a, double b, double share) {
  return share == 0 ? a : a + share * (b - a);
}

// Where the posts of a quadnode lie among those of an ancestor: ancestor column = first + column / per_cell.
struct Alignment {
  double first_column = 0;
  double first_row = 0;
  double columns_per_cell = 1;
  double rows_per_cell = 1;
};

Alignment Align(Quadcode node, Quadcode ancestor) {
  const double east = ancestor.PostSpacingEast();
  const double north = ancestor.PostSpacingNorth();
  const GridPoint from = ancestor.SouthWest();
  const GridPoint to = node.SouthWest();
  return {(to.x - from.x) / east, (to.y - from.y) / north, east / node.PostSpacingEast(),
          north / node.PostSpacingNorth()};
}

struct Sample {
  double height_mm = 0;
  double rise_east_mm = 0;  // over two of the ancestor's post spacings
  double rise_north_mm = 0;
};

Sample SampleAtPost(const ElevationPage& page, int column, int row) {
  return {static_cast<double>(page.at(column, row)),
          static_cast<double>(page.at(column + 1, row)) - page.at(column - 1, row),
          static_cast<double>(page.at(column, row + 1)) - page.at(column, row - 1)};
}

Sample SampleBetween(const ElevationPage& page, double column, double row) {
  const int west = static_cast<int>(column);
  const int south = static_cast<int>(row);
  const double x = column - west;
  const double y = row - south;
  const Sample sw = SampleAtPost(page, west, south);
  const Sample se = x == 0 ? sw : SampleAtPost(page, west + 1, south);
  const Sample nw = y == 0 ? sw : SampleAtPost(page, west, south + 1);
  const Sample ne = x == 0 ? nw : y == 0 ? se : SampleAtPost(page, west + 1, south + 1);
  const auto mix = [&](double Sample::*value) {
    return Mix(Mix(sw.*value, se.*value, x), Mix(nw.*value, ne.*value, x), y);
  };
  return {mix(&Sample::height_mm), mix(&Sample::rise_east_mm), mix(&Sample::rise_north_mm)};
}

}  // namespace

HeightField SampleHeights(Quadcode node, const ElevationPage* page, Quadcode heights_node, double exaggeration) {
  HeightField field;
  field.height_m.assign(kVerticesPerPage, 0.0);
  field.slope_east.assign(kVerticesPerPage, 0.0F);
  field.slope_north.assign(kVerticesPerPage, 0.0F);
  if (page == nullptr) return field;
  BELVEDERE_CHECK(heights_node.Contains(node));

  const Alignment alignment = Align(node, heights_node);
  const bool own_heights = heights_node == node;
  const double run_east = 2.0 * heights_node.WidthDegrees() / kCells * kRadiansPerDegree;
  const double run_north = 2.0 * heights_node.HeightDegrees() / kCells * kRadiansPerDegree;
  const double metres = kMetresPerMillimetre * exaggeration;
  for (int row = 0; row < kPosts; ++row) {
    const double latitude_deg =
        GridPoint{0, node.SouthWest().y + static_cast<uint32_t>(row) * node.PostSpacingNorth()}.latitude_deg();
    const RowGeometry geometry = RowAt(latitude_deg);
    const bool at_pole = geometry.cos_latitude == 0;
    const double east = at_pole ? 0 : metres / (run_east * geometry.prime_vertical_m * geometry.cos_latitude);
    const double north = at_pole ? 0 : metres / (run_north * geometry.meridian_m);
    for (int column = 0; column < kPosts; ++column) {
      const Sample sample = own_heights
                                ? SampleAtPost(*page, column, row)
                                : SampleBetween(*page, alignment.first_column + column / alignment.columns_per_cell,
                                                alignment.first_row + row / alignment.rows_per_cell);
      const auto index = static_cast<size_t>(row * kPosts + column);
      field.height_m[index] = at_pole && column > 0 ? field.height_m[index - 1] : sample.height_mm * metres;
      field.slope_east[index] = static_cast<float>(sample.rise_east_mm * east);
      field.slope_north[index] = static_cast<float>(sample.rise_north_mm * north);
    }
  }
  return field;
}

}  // namespace belvedere

#include "preproc/lattice.h"

#include "runtime/paging/page.h"

#include <utility>

namespace belvedere {
namespace {

constexpr int64_t kTurn = int64_t{1} << 32;  // grid units of 360 degrees
constexpr int64_t kPole = int64_t{1} << 31;  // grid units of latitude from pole to pole

double LongitudeOfGrid(int64_t x) {
  return GridPoint{static_cast<uint32_t>(x & (kTurn - 1)), 0}.longitude_deg();
}
double LatitudeOfGrid(int64_t y) {
  return GridPoint{0, static_cast<uint32_t>(y)}.latitude_deg();
}

// Groups in order of the page's rows: those with latitude as it is, beyond a pole, and on a pole.
struct Grouped {
  LatticeRows plain, mirrored, pole;
  std::vector<LatticeRows> Take() {
    std::vector<LatticeRows> groups;
    for (LatticeRows* group : {&plain, &mirrored, &pole}) {
      if (!group->rows.empty()) groups.push_back(std::move(*group));
    }
    return groups;
  }
};

void Append(LatticeRows& group, double latitude_deg, int row) {
  group.latitudes_deg.push_back(latitude_deg);
  group.rows.push_back(row);
}

}  // namespace

Spacing PostSpacingOf(Quadcode node) {
  return {node.WidthDegrees() / kCells, node.HeightDegrees() / kCells};
}
Spacing TexelSpacingOf(Quadcode node) {
  return {node.WidthDegrees() / kImageInner, node.HeightDegrees() / kImageInner};
}

std::vector<LatticeRows> PostLattice(Quadcode node) {
  const GridPoint corner = node.SouthWest();
  const int64_t east = node.PostSpacingEast(), north = node.PostSpacingNorth();
  Grouped groups;
  for (int i = 0; i < kElevationSide; ++i) {
    const int64_t x = int64_t{corner.x} + (i - kApron) * east;
    groups.plain.longitudes_deg.push_back(LongitudeOfGrid(x));
    groups.mirrored.longitudes_deg.push_back(LongitudeOfGrid(x + kTurn / 2));
  }
  groups.pole.longitudes_deg = {LongitudeOfGrid(0)};
  for (int j = 0; j < kElevationSide; ++j) {
    const int64_t y = int64_t{corner.y} + (j - kApron) * north;
    if (y == 0 || y == kPole) {
      Append(groups.pole, LatitudeOfGrid(y), j);
    } else if (y < 0 || y > kPole) {
      Append(groups.mirrored, LatitudeOfGrid(y < 0 ? -y : 2 * kPole - y), j);
    } else {
      Append(groups.plain, LatitudeOfGrid(y), j);
    }
  }
  return groups.Take();
}

LatticeRows PostsAround(Quadcode node, int west, int south, int columns, int rows) {
  const GridPoint corner = node.SouthWest();
  const int64_t east = node.PostSpacingEast(), north = node.PostSpacingNorth();
  LatticeRows posts;
  for (int i = west; i < west + columns; ++i) posts.longitudes_deg.push_back(LongitudeOfGrid(corner.x + i * east));
  for (int j = south; j < south + rows; ++j) {
    const int64_t y = int64_t{corner.y} + j * north;
    if (y >= 0 && y <= kPole) Append(posts, LatitudeOfGrid(y), j);
  }
  return posts;
}

std::vector<LatticeRows> TexelLattice(Quadcode node) {
  const int level = node.level();
  const int64_t around = Quadcode::ColumnsAround(level, node.row()) * kImageInner;
  const int64_t upright = (int64_t{kTreeRows} << level) * kImageInner;
  const Spacing spacing = TexelSpacingOf(node);
  const auto longitude = [&](int64_t texel) {
    const int64_t wrapped = ((texel % around) + around) % around;
    return (static_cast<double>(wrapped) + 0.5) * spacing.east_deg - 180.0;
  };
  Grouped groups;
  for (int i = 0; i < kImageSide; ++i) {
    const int64_t texel = node.column() * kImageInner + i - kImageGutter;
    groups.plain.longitudes_deg.push_back(longitude(texel));
    groups.mirrored.longitudes_deg.push_back(longitude(texel + around / 2));
  }
  for (int j = 0; j < kImageSide; ++j) {
    const int64_t texel = node.row() * kImageInner + j - kImageGutter;
    const bool beyond = texel < 0 || texel >= upright;
    const int64_t row = texel < 0 ? -1 - texel : texel >= upright ? 2 * upright - 1 - texel : texel;
    Append(beyond ? groups.mirrored : groups.plain, (static_cast<double>(row) + 0.5) * spacing.north_deg - 90.0, j);
  }
  return groups.Take();
}

}  // namespace belvedere

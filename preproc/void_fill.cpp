#include "preproc/void_fill.h"

#include "preproc/plan.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/page.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

constexpr double kReachPixels = 64;
constexpr int kWidestMargin = 4;  // columns to a row, near a pole
constexpr double kMetresPerDegree = kEquatorialRadius_m * kRadiansPerDegree;
constexpr GridRange kTile{0, 0, kPosts, kPosts};

DeltaGrid GridOf(const VoidFill::Ground& ground, const LatticeRows& lattice, Quadcode node) {
  DeltaGrid grid;
  grid.columns = static_cast<int>(lattice.longitudes_deg.size());
  grid.rows = static_cast<int>(lattice.latitudes_deg.size());
  grid.row_m = node.HeightDegrees() / kCells * kMetresPerDegree;
  const double equator_m = node.WidthDegrees() / kCells * kMetresPerDegree;
  for (const double latitude_deg : lattice.latitudes_deg)
    grid.column_m.push_back(equator_m * std::max(std::cos(latitude_deg * kRadiansPerDegree), 1e-6));
  grid.posts = ground.posts;
  grid.deltas_m.assign(ground.posts.size(), std::numeric_limits<double>::quiet_NaN());
  for (size_t i = 0; i < ground.posts.size(); ++i) {
    if (ground.posts[i] == DeltaGrid::Post::kValid) grid.deltas_m[i] = ground.source_m[i] - ground.below_m[i];
  }
  return grid;
}

// The smallest range that holds all void posts; empty where there are none.
GridRange VoidsOf(const DeltaGrid& grid) {
  GridRange range{grid.columns, grid.rows, 0, 0};
  size_t at = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column, ++at) {
      if (grid.posts[at] != DeltaGrid::Post::kVoid) continue;
      range = {std::min(range.west, column), std::min(range.south, row), std::max(range.east, column + 1),
               std::max(range.north, row + 1)};
    }
  }
  return range;
}

// As far around the voids as the surface reaches, a post more to tell the rim, and the tile.
GridRange Widened(const DeltaGrid& grid, const GridRange& voids, double reach_m) {
  const int rows = static_cast<int>(reach_m / grid.row_m) + 1;
  const double narrowest_m =
      std::min(grid.column_m[static_cast<size_t>(voids.south)], grid.column_m[static_cast<size_t>(voids.north - 1)]);
  const int columns = static_cast<int>(std::min(reach_m / narrowest_m, double{kWidestMargin} * rows)) + 1;
  return {std::min(voids.west - columns, kTile.west), std::min(voids.south - rows, kTile.south),
          std::max(voids.east + columns, kTile.east), std::max(voids.north + rows, kTile.north)};
}

}  // namespace

std::vector<double> VoidFill::Make(size_t source, Quadcode node, double reach_m) const {
  LatticeRows lattice = PostsAround(node, kTile.west, kTile.south, kPosts, kPosts);
  DeltaGrid grid = GridOf(ground_of_(source, lattice, node), lattice, node);
  const GridRange voids = VoidsOf(grid);
  if (voids.west >= voids.east) return std::move(grid.deltas_m);
  const GridRange wide = Widened(grid, voids, reach_m);
  lattice = PostsAround(node, wide.west, wide.south, wide.east - wide.west, wide.north - wide.south);
  grid = GridOf(ground_of_(source, lattice, node), lattice, node);
  const int first_row = -lattice.rows.front(), first_column = -wide.west;  // of the tile within
  FillVoids(grid, {first_column, first_row, first_column + kPosts, first_row + kPosts}, reach_m);
  std::vector<double> deltas_m;
  for (int row = first_row; row < first_row + kPosts; ++row) {
    const auto from = grid.deltas_m.begin() + static_cast<std::ptrdiff_t>(row) * grid.columns + first_column;
    deltas_m.insert(deltas_m.end(), from, from + kPosts);
  }
  return deltas_m;
}

std::shared_ptr<const VoidFill::Tile> VoidFill::TileOf(size_t source, Quadcode node, double reach_m) {
  const auto found = std::find_if(tiles_.begin(), tiles_.end(), [&](const std::shared_ptr<const Tile>& tile) {
    return tile->source == source && tile->node == node;
  });
  if (found != tiles_.end()) {
    tiles_.splice(tiles_.begin(), tiles_, found);
    return tiles_.front();
  }
  auto tile = std::make_shared<const Tile>(Tile{source, node, Make(source, node, reach_m)});
  tiles_.push_front(tile);
  if (tiles_.size() > kMostTiles) tiles_.pop_back();
  return tile;
}

double VoidFill::DeltaAt(size_t source, const Georeference& georeference, int level, double longitude_deg,
                         double latitude_deg) {
  const double pixel_deg = georeference.spacing_deg();
  const int coarser = std::min(level, FinestLevel(pixel_deg, LayerKind::kElevation));
  const Quadcode node = Quadcode::Containing(latitude_deg, longitude_deg, coarser);
  const auto tile = TileOf(source, node, kReachPixels * pixel_deg * kMetresPerDegree);
  const GeoBox box = node.Box();
  const double x = std::clamp((longitude_deg - box.west_deg) * kCells / node.WidthDegrees(), 0.0, double{kCells});
  const double y = std::clamp((latitude_deg - box.south_deg) * kCells / node.HeightDegrees(), 0.0, double{kCells});
  const int column = std::min(static_cast<int>(x), kCells - 1), row = std::min(static_cast<int>(y), kCells - 1);
  double sum = 0, weights = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const int i = column + corner % 2, j = row + corner / 2;
    const double weight = (1 - std::abs(x - i)) * (1 - std::abs(y - j));
    const double delta_m = tile->deltas_m[static_cast<size_t>(j) * kPosts + static_cast<size_t>(i)];
    if (weight <= 0 || std::isnan(delta_m)) continue;
    sum += weight * delta_m;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace belvedere

#include "preproc/delta_surface.h"

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

// Columns of a row that are looked at are at most so many times the rows: near a pole they are narrow.
constexpr int kWidestRow = 4;

struct RimPost {
  int column = 0;
  double delta_m = 0;
};

bool IsOnRim(const DeltaGrid& grid, int column, int row) {
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, grid.rows - 1); ++j) {
    for (int i = std::max(column - 1, 0); i <= std::min(column + 1, grid.columns - 1); ++i) {
      if (grid.posts[static_cast<size_t>(j) * static_cast<size_t>(grid.columns) + static_cast<size_t>(i)] ==
          DeltaGrid::Post::kVoid)
        return true;
    }
  }
  return false;
}

// The valid posts beside voids, row by row.
std::vector<std::vector<RimPost>> RimOf(const DeltaGrid& grid) {
  std::vector<std::vector<RimPost>> rim(static_cast<size_t>(grid.rows));
  size_t at = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column, ++at) {
      if (grid.posts[at] == DeltaGrid::Post::kValid && IsOnRim(grid, column, row))
        rim[static_cast<size_t>(row)].push_back({column, grid.deltas_m[at]});
    }
  }
  return rim;
}

double Fade(double share) {
  const double t = std::clamp(2 * share - 1, 0.0, 1.0);
  return 1 - t * t * (3 - 2 * t);
}

double DeltaAt(const DeltaGrid& grid, const std::vector<std::vector<RimPost>>& rim, int column, int row,
               double reach_m) {
  const double column_m = grid.column_m[static_cast<size_t>(row)];
  const int rows_away = static_cast<int>(reach_m / grid.row_m);
  const int columns_away = static_cast<int>(std::min(reach_m / column_m, double{kWidestRow} * rows_away));
  double sum = 0, weights = 0, nearest_m2 = reach_m * reach_m;
  for (int j = std::max(row - rows_away, 0); j <= std::min(row + rows_away, grid.rows - 1); ++j) {
    const std::vector<RimPost>& posts = rim[static_cast<size_t>(j)];
    const double north_m = (j - row) * grid.row_m;
    auto post = std::lower_bound(posts.begin(), posts.end(), column - columns_away,
                                 [](const RimPost& a, int wanted) { return a.column < wanted; });
    for (; post != posts.end() && post->column <= column + columns_away; ++post) {
      const double east_m = (post->column - column) * column_m;
      const double distance_m2 = east_m * east_m + north_m * north_m;
      if (distance_m2 >= reach_m * reach_m) continue;
      const double inverse = 1 / std::sqrt(distance_m2) - 1 / reach_m;
      sum += inverse * inverse * post->delta_m;
      weights += inverse * inverse;
      nearest_m2 = std::min(nearest_m2, distance_m2);
    }
  }
  return weights > 0 ? sum / weights * Fade(std::sqrt(nearest_m2) / reach_m) : 0;
}

}  // namespace

void FillVoids(DeltaGrid& grid, const GridRange& range, double reach_m) {
  const std::vector<std::vector<RimPost>> rim = RimOf(grid);
  for (int row = range.south; row < range.north; ++row) {
    for (int column = range.west; column < range.east; ++column) {
      const size_t at = static_cast<size_t>(row) * static_cast<size_t>(grid.columns) + static_cast<size_t>(column);
      if (grid.posts[at] == DeltaGrid::Post::kVoid) grid.deltas_m[at] = DeltaAt(grid, rim, column, row, reach_m);
    }
  }
}

}  // namespace belvedere

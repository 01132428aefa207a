#include "preproc/delta_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace belvedere {
namespace {

constexpr double kSpacing_m = 10;

// Posts (0, 0) to (columns, rows) of a plane of posts, from `west` and `south` on.
DeltaGrid MakeGrid(int west, int south, int columns, int rows, const std::function<bool(int, int)>& is_void,
                   const std::function<double(int, int)>& delta_m) {
  DeltaGrid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.row_m = kSpacing_m;
  for (int row = 0; row < rows; ++row) {
    grid.column_m.push_back(kSpacing_m * (1 - 0.002 * (south + row)));
    for (int column = 0; column < columns; ++column) {
      const bool missing = is_void(west + column, south + row);
      grid.posts.push_back(missing ? DeltaGrid::Post::kVoid : DeltaGrid::Post::kValid);
      grid.deltas_m.push_back(missing ? std::nan("") : delta_m(west + column, south + row));
    }
  }
  return grid;
}

double At(const DeltaGrid& grid, int column, int row) {
  return grid.deltas_m[static_cast<size_t>(row * grid.columns + column)];
}

auto Disc(int radius) {
  return [=](int column, int row) { return std::hypot(column - 50, row - 50) < radius; };
}

TEST(DeltaSurface, AnOffsetIsCarriedRightThroughTheVoid) {
  DeltaGrid grid = MakeGrid(0, 0, 100, 100, Disc(20), [](int, int) { return 37.5; });
  FillVoids(grid, {0, 0, 100, 100}, 640);
  for (const double delta_m : grid.deltas_m) EXPECT_NEAR(delta_m, 37.5, 1e-9);
}

TEST(DeltaSurface, ItMeetsTheRimAndStaysWithinIt) {
  const auto tilted = [](int column, int row) { return 0.5 * column - 0.2 * row; };
  DeltaGrid grid = MakeGrid(0, 0, 100, 100, Disc(20), tilted);
  FillVoids(grid, {0, 0, 100, 100}, 640);
  for (int row = 0; row < 100; ++row) {
    for (int column = 1; column < 100; ++column) {
      if (!Disc(20)(column, row) && !Disc(20)(column - 1, row)) {
        EXPECT_EQ(At(grid, column, row), tilted(column, row)) << "valid posts are left as they are";
      }
      EXPECT_NEAR(At(grid, column, row), At(grid, column - 1, row), 1.6) << column << " " << row;
    }
  }
  EXPECT_NEAR(At(grid, 50, 50), tilted(50, 50), 0.5);
  EXPECT_GT(At(grid, 60, 50), At(grid, 40, 50) + 4) << "it leans as the rim does";
}

TEST(DeltaSurface, BeyondItsReachThereIsNone) {
  DeltaGrid grid = MakeGrid(0, 0, 100, 100, Disc(45), [](int, int) { return 100.0; });
  FillVoids(grid, {0, 0, 100, 100}, 200);
  EXPECT_EQ(At(grid, 50, 50), 0.0);
  double before = 100;
  for (int column = 6; column < 50; ++column) {
    EXPECT_LE(At(grid, column, 50), before + 1e-9);
    EXPECT_LT(before - At(grid, column, 50), 16) << "it fades, and does not break off";
    before = At(grid, column, 50);
  }
  EXPECT_NEAR(At(grid, 14, 50), 100.0, 1e-9) << "whole up to half of its reach";
}

TEST(DeltaSurface, APostHasTheSameBitsInEveryGridThatHoldsItsReach) {
  const auto noise = [](int column, int row) { return std::sin(12.9 * column + 78.2 * row) * 50; };
  DeltaGrid whole = MakeGrid(0, 0, 100, 100, Disc(20), noise);
  FillVoids(whole, {0, 0, 100, 100}, 150);
  DeltaGrid part = MakeGrid(30, 20, 60, 70, Disc(20), noise);
  FillVoids(part, {18, 18, 40, 50}, 150);
  for (int row = 18; row < 50; ++row) {
    for (int column = 18; column < 40; ++column)
      EXPECT_EQ(At(part, column, row), At(whole, column + 30, row + 20)) << column << " " << row;
  }
}

}  // namespace
}  // namespace belvedere

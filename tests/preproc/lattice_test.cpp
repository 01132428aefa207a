#include "preproc/lattice.h"

#include "runtime/paging/page.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace belvedere {
namespace {

struct Position {
  double longitude_deg, latitude_deg;
  bool operator==(const Position&) const = default;
};

// By column and row of the page.
std::map<std::pair<int, int>, Position> Positions(const std::vector<LatticeRows>& groups, int side) {
  std::map<std::pair<int, int>, Position> positions;
  for (const LatticeRows& group : groups) {
    for (size_t j = 0; j < group.rows.size(); ++j) {
      for (int i = 0; i < side; ++i) {
        const size_t column = group.longitudes_deg.size() == 1 ? 0 : static_cast<size_t>(i);
        positions[{i, group.rows[j]}] = {group.longitudes_deg[column], group.latitudes_deg[j]};
      }
    }
  }
  EXPECT_EQ(positions.size(), static_cast<size_t>(side) * static_cast<size_t>(side));
  return positions;
}

void ExpectNeighboursAgree(int level, int64_t column, int64_t row) {
  const Quadcode node = Quadcode::FromColumnRow(level, column, row);
  const Quadcode east = Quadcode::FromColumnRow(level, column + 1, row);
  const auto own_posts = Positions(PostLattice(node), kElevationSide);
  const auto east_posts = Positions(PostLattice(east), kElevationSide);
  for (int j = 0; j < kElevationSide; ++j) {
    for (int i = kCells; i < kElevationSide; ++i) {
      EXPECT_EQ(own_posts.at({i, j}), east_posts.at({i - kCells, j})) << node.ToString() << " " << i << " " << j;
    }
  }
  const auto own_texels = Positions(TexelLattice(node), kImageSide);
  const auto east_texels = Positions(TexelLattice(east), kImageSide);
  for (int j = 0; j < kImageSide; ++j) {
    for (int i = kImageInner; i < kImageSide; ++i)
      EXPECT_EQ(own_texels.at({i, j}), east_texels.at({i - kImageInner, j}));
  }
  if (row + 1 >= (int64_t{kTreeRows} << level)) return;
  const Quadcode north = Quadcode::FromColumnRow(level, column, row + 1);
  if (north.Doublings() != node.Doublings()) return;
  const auto north_posts = Positions(PostLattice(north), kElevationSide);
  for (int j = kCells; j < kElevationSide; ++j) {
    for (int i = 0; i < kElevationSide; ++i) EXPECT_EQ(own_posts.at({i, j}), north_posts.at({i, j - kCells}));
  }
}

TEST(Lattice, NeighboursShareTheirPositionsToTheBit) {
  std::mt19937_64 random(7);
  for (int level = 0; level <= kMaxLevel; level += 2) {
    const int64_t columns = int64_t{kTreeColumns} << level;
    const int64_t rows = int64_t{kTreeRows} << level;
    ExpectNeighboursAgree(level, columns - 1, rows / 2);          // over 180 E
    ExpectNeighboursAgree(level, columns / 8 - 1, rows / 4 - 1);  // between trees, both ways
    ExpectNeighboursAgree(level, 0, 0);
    ExpectNeighboursAgree(level, columns - 1, rows - 1);
    ExpectNeighboursAgree(level, static_cast<int64_t>(random() % static_cast<uint64_t>(columns)),
                          static_cast<int64_t>(random() % static_cast<uint64_t>(rows)));
  }
}

TEST(Lattice, APoleIsOnePosition) {
  for (const int64_t row : {int64_t{0}, int64_t{7}}) {
    for (int64_t column = 0; column < 8; column += 3) {
      const auto posts = Positions(PostLattice(Quadcode::FromColumnRow(1, column, row)), kElevationSide);
      const int pole_row = row == 0 ? kApron : kApron + kCells;
      for (int i = 0; i < kElevationSide; ++i) {
        EXPECT_EQ(posts.at({i, pole_row}), (Position{-180.0, row == 0 ? -90.0 : 90.0}));
      }
    }
  }
}

TEST(Lattice, BeyondAPoleIsHalfATurnFurther) {
  const Quadcode node = Quadcode::FromColumnRow(2, 1, 15);
  const Quadcode opposite = Quadcode::FromColumnRow(2, 1 + 4, 15);
  const auto own = Positions(TexelLattice(node), kImageSide);
  const auto there = Positions(TexelLattice(opposite), kImageSide);
  for (int beyond = 0; beyond < kImageGutter; ++beyond) {
    for (int i = 0; i < kImageSide; ++i) {
      EXPECT_EQ(own.at({i, kImageSide - kImageGutter + beyond}), there.at({i, kImageSide - kImageGutter - 1 - beyond}));
    }
  }
}

TEST(Lattice, PostsAndTexelsLieWhereThePageSays) {
  const Quadcode node = Quadcode::FromColumnRow(3, 11, 21);
  const GeoBox box = node.Box();
  const auto posts = Positions(PostLattice(node), kElevationSide);
  EXPECT_EQ(posts.at({kApron, kApron}), (Position{box.west_deg, box.south_deg}));
  EXPECT_EQ(posts.at({kApron + kCells, kApron + kCells}), (Position{box.east_deg, box.north_deg}));
  const auto texels = Positions(TexelLattice(node), kImageSide);
  EXPECT_NEAR(texels.at({kImageGutter, 0}).longitude_deg, box.west_deg + 0.5 * node.HeightDegrees() / kImageInner,
              1e-12);
}

}  // namespace
}  // namespace belvedere

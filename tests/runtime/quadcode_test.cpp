#include "runtime/earth/quadcode.h"

#include "runtime/earth/units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <unordered_set>

namespace belvedere {
namespace {

std::vector<Quadcode> SomeNodes() {
  std::mt19937_64 random(11);
  std::vector<Quadcode> nodes;
  for (int level = 0; level <= kMaxLevel; ++level) {
    const uint64_t columns = uint64_t{kTreeColumns} << level;
    const uint64_t rows = uint64_t{kTreeRows} << level;
    nodes.push_back(Quadcode::FromColumnRow(level, 0, 0));
    nodes.push_back(Quadcode::FromColumnRow(level, static_cast<int64_t>(columns) - 1, static_cast<int64_t>(rows) - 1));
    for (int i = 0; i < 20; ++i) {
      nodes.push_back(Quadcode::FromColumnRow(level, static_cast<int64_t>(random() % columns),
                                              static_cast<int64_t>(random() % rows)));
    }
  }
  return nodes;
}

TEST(Quadcode, ItsBitsAreAsDocumented) {
  EXPECT_EQ(Quadcode::Root(0).word(), 0u);
  EXPECT_EQ(Quadcode::Root(31).word(), uint64_t{31} << 59);
  EXPECT_EQ(Quadcode::Root(12).Child(0).code(), 1u);
  EXPECT_EQ(Quadcode::Root(12).Child(3).code(), 4u);
  EXPECT_EQ(Quadcode::Root(12).Child(3).Child(2).code(), 4u * 4 + 3);
  EXPECT_EQ(Quadcode::Root(12).Child(3).tree(), 12);
}

TEST(Quadcode, TreesRunEastThenNorth) {
  EXPECT_EQ(Quadcode::Containing(-80, -170, 0), Quadcode::Root(0));
  EXPECT_EQ(Quadcode::Containing(-80, 170, 0), Quadcode::Root(7));
  EXPECT_EQ(Quadcode::Containing(-10, -170, 0), Quadcode::Root(8));
  EXPECT_EQ(Quadcode::Containing(80, 170, 0), Quadcode::Root(31));
  const GeoBox box = Quadcode::Root(12).Box();
  EXPECT_EQ(box.west_deg, 0);
  EXPECT_EQ(box.east_deg, 45);
  EXPECT_EQ(box.south_deg, -45);
  EXPECT_EQ(box.north_deg, 0);
}

TEST(Quadcode, ChildrenAreSouthWestSouthEastNorthWestNorthEast) {
  const Quadcode node = Quadcode::Containing(10, 20, 5);
  for (int which = 0; which < 4; ++which) {
    const Quadcode child = node.Child(which);
    EXPECT_EQ(child.column(), 2 * node.column() + which % 2);
    EXPECT_EQ(child.row(), 2 * node.row() + which / 2);
    EXPECT_EQ(child.WhichChild(), which);
    EXPECT_EQ(child.Parent(), node);
    EXPECT_EQ(child.level(), 6);
  }
}

TEST(Quadcode, RoundTripsThroughColumnsAndRows) {
  for (const Quadcode node : SomeNodes()) {
    EXPECT_EQ(Quadcode::FromColumnRow(node.level(), node.column(), node.row()), node);
    EXPECT_EQ(Quadcode::FromWord(node.word()), node);
    EXPECT_EQ(Quadcode::Parse(node.ToString()), node);
    const int64_t columns = Quadcode::ColumnsAround(node.level(), node.row());
    EXPECT_EQ(Quadcode::FromColumnRow(node.level(), node.column() - columns, node.row()), node);
    EXPECT_EQ(Quadcode::FromColumnRow(node.level(), node.column() + columns, node.row()), node);
  }
}

TEST(Quadcode, AncestorsContainTheirDescendants) {
  for (const Quadcode node : SomeNodes()) {
    Quadcode up = node;
    for (int level = node.level(); level >= 0; --level) {
      EXPECT_EQ(node.Ancestor(level), up);
      EXPECT_TRUE(up.Contains(node));
      EXPECT_EQ(node.Contains(up), node == up);
      if (level > 0) up = up.Parent();
    }
    EXPECT_TRUE(up.is_root());
    EXPECT_FALSE(Quadcode::Root((node.tree() + 1) % kTrees).Contains(node));
  }
}

TEST(Quadcode, ContainsThePositionsOfItsBox) {
  for (const Quadcode node : SomeNodes()) {
    const GeoBox box = node.Box();
    const double latitude = 0.5 * (box.south_deg + box.north_deg);
    const double longitude = 0.5 * (box.west_deg + box.east_deg);
    EXPECT_EQ(Quadcode::Containing(latitude, longitude, node.level()), node);
    EXPECT_EQ(Quadcode::Containing(box.south_deg, box.west_deg, node.level()),
              node);  // a border belongs to the north-east
  }
  EXPECT_EQ(Quadcode::Containing(90, 0, 3).row(), (kTreeRows << 3) - 1);
  EXPECT_EQ(Quadcode::Containing(0, 180, 3), Quadcode::Containing(0, -180, 3));
}

TEST(Quadcode, GridPointsMeetOverAllLevels) {
  for (const Quadcode node : SomeNodes()) {
    const GridPoint corner = node.SouthWest();
    EXPECT_DOUBLE_EQ(corner.longitude_deg(), node.Box().west_deg);
    EXPECT_DOUBLE_EQ(corner.latitude_deg(), node.Box().south_deg);
    EXPECT_EQ(node.PostSpacingNorth() * kCells, node.GridHeight());
    EXPECT_EQ(node.PostSpacingEast() * kCells, node.GridWidth());
    if (node.level() == kMaxLevel) continue;
    EXPECT_EQ(node.Child(0).SouthWest(), corner);
    const Quadcode last = node.Child(node.Children().back());
    EXPECT_EQ(last.SouthWest().x + last.GridWidth() - corner.x, node.GridWidth());
    EXPECT_EQ(last.SouthWest().y + last.GridHeight() - corner.y, node.GridHeight());
  }
  const Quadcode last = Quadcode::FromColumnRow(4, -1, 0);
  EXPECT_EQ(last.SouthWest().x + last.GridWidth(), 0u);  // 180 E is 180 W
  EXPECT_EQ(Quadcode::Root(31).SouthWest().y + Quadcode::Root(31).GridHeight(), kGridNorthPole);
}

// Decision 0023.
TEST(Quadcode, EightMeetAtAPoleAndNoneIsASlice) {
  for (int level = 1; level <= kMaxLevel; ++level) {
    for (const int64_t row : {int64_t{0}, (int64_t{kTreeRows} << level) - 1}) {
      EXPECT_EQ(Quadcode::ColumnsAround(level, row), kTreeColumns);
      EXPECT_EQ(Quadcode::FromColumnRow(level, 3, row).WidthDegrees(), kTreeDegrees);
    }
  }
  for (int level = 3; level <= 12; ++level) {
    for (double latitude_deg = 67.6; latitude_deg < 89.9; latitude_deg += 0.37) {
      const Quadcode node = Quadcode::Containing(-latitude_deg, 100, level);
      if (node.touches_south_pole()) continue;
      const GeoBox box = node.Box();
      const double ratio = node.WidthDegrees() / node.HeightDegrees();
      EXPECT_LT(ratio * std::cos(box.north_deg * kRadiansPerDegree), 1.6) << node.ToString();
      EXPECT_GT(ratio * std::cos(box.south_deg * kRadiansPerDegree), 0.7) << node.ToString();
    }
  }
  EXPECT_EQ(Quadcode::Containing(67.4, 10, 9).Doublings(), 0);
  EXPECT_EQ(Quadcode::Containing(67.6, 10, 9).Doublings(), 2);
  EXPECT_EQ(Quadcode::Containing(79, 10, 9).Doublings(), 3);
}

TEST(Quadcode, ChildrenCoverTheirParentOnce) {
  std::vector<Quadcode> nodes = SomeNodes();
  for (int tree = 0; tree < kTrees; ++tree) nodes.push_back(Quadcode::Root(tree));
  for (const Quadcode node : nodes) {
    if (node.level() == kMaxLevel) continue;
    double area = 0;
    const GeoBox box = node.Box();
    for (const int which : node.Children()) {
      const Quadcode child = node.Child(which);
      EXPECT_EQ(child.Parent(), node);
      EXPECT_EQ(Quadcode::FromWord(child.word()), child);
      EXPECT_GE(child.Box().west_deg, box.west_deg);
      EXPECT_LE(child.Box().east_deg, box.east_deg);
      EXPECT_EQ(child.Box().south_deg, which < 2 ? box.south_deg : 0.5 * (box.south_deg + box.north_deg));
      area += child.WidthDegrees() * child.HeightDegrees();
    }
    EXPECT_EQ(area, node.WidthDegrees() * node.HeightDegrees());
    for (int which = 0; which < 4; ++which) {
      const std::span<const int> children = node.Children();
      if (std::find(children.begin(), children.end(), which) != children.end()) continue;
      EXPECT_EQ(Quadcode::FromWord(node.Child(which).word()), std::nullopt) << node.ToString();
    }
  }
}

TEST(Quadcode, WhatIsAroundTouchesIt) {
  const Quadcode plain = Quadcode::Containing(10, 20, 6);
  EXPECT_EQ(plain.Around().size(), 9u);
  // Below 67.5 degrees four quadnodes are as wide as one above it.
  const std::vector<Quadcode> around = Quadcode::Containing(67.51, 20, 6).Around();
  EXPECT_EQ(std::count_if(around.begin(), around.end(), [](Quadcode q) { return q.Doublings() == 0; }), 6);
  EXPECT_EQ(around.size(), 12u);
  for (const Quadcode node : SomeNodes()) {
    const std::vector<Quadcode> all = node.Around();
    EXPECT_NE(std::find(all.begin(), all.end(), node), all.end());
    for (const Quadcode other : all) {
      EXPECT_EQ(other.level(), node.level());
      EXPECT_LE(std::abs(other.row() - node.row()), 1);
      const uint32_t a = node.SouthWest().x, b = other.SouthWest().x;
      EXPECT_TRUE(b - a <= node.GridWidth() || a - b <= other.GridWidth()) << node.ToString() << other.ToString();
    }
  }
}

TEST(Quadcode, BesideAParallelLiesTheCoarsestThatIsNoWider) {
  const Quadcode plain = Quadcode::Containing(10, 20, 6);
  EXPECT_EQ(plain.BesideParallel(true), Quadcode::FromColumnRow(6, plain.column(), plain.row() + 1));
  EXPECT_EQ(plain.BesideParallel(false), Quadcode::FromColumnRow(6, plain.column(), plain.row() - 1));
  const Quadcode below = Quadcode::Containing(67.49, 20, 6), above = Quadcode::Containing(67.51, 20, 8);
  EXPECT_EQ(below.BesideParallel(true), above);
  EXPECT_EQ(above.BesideParallel(false), below);
  EXPECT_EQ(Quadcode::Containing(80, 20, 1).BesideParallel(false), Quadcode::Containing(67.49, 1, 1));
  EXPECT_EQ(Quadcode::Containing(89.9, 20, 4).BesideParallel(true), std::nullopt);
  EXPECT_EQ(Quadcode::Containing(-89.9, 20, 4).BesideParallel(false), std::nullopt);
  EXPECT_EQ(Quadcode::Containing(67.4999999, 20, kMaxLevel).BesideParallel(true), std::nullopt);
}

TEST(Quadcode, RefusesWordsAndTextsThatNameNothing) {
  EXPECT_EQ(Quadcode::FromWord((uint64_t{1} << 59) - 1), std::nullopt);
  for (const char* text : {"", ":", "12", "32:", "-1:", "1x:", "12:4", "12:01a", "12:00000000000000000000000", "24:3",
                           "24:21", "0:1", "0:03"}) {
    EXPECT_EQ(Quadcode::Parse(text), std::nullopt) << text;
  }
  EXPECT_EQ(Quadcode::Parse("12:"), Quadcode::Root(12));
  EXPECT_EQ(Quadcode::Root(12).Child(0).Child(3).ToString(), "12:03");
}

TEST(Quadcode, HashesDiffer) {
  std::unordered_set<size_t> hashes;
  for (int64_t column = 0; column < 100; ++column) {
    for (int64_t row = 0; row < 100; ++row)
      hashes.insert(std::hash<Quadcode>()(Quadcode::FromColumnRow(9, column, 1000 + row)) & 0xFFFFF);
  }
  EXPECT_GT(hashes.size(), 9000u);  // of 10,000 in a million slots
}

}  // namespace
}  // namespace belvedere

#include "preproc/void_map.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

VoidMap MapOf(const std::vector<std::string>& rows, bool wraps = false) {
  VoidFinder finder(static_cast<int>(rows.front().size()), wraps);
  for (const std::string& row : rows) {
    std::vector<uint8_t> missing;
    for (const char c : row) missing.push_back(c == '.' ? 1 : 0);
    finder.AddRow(missing);
  }
  return finder.Finish();
}

// The rows again, with v where a void is.
std::vector<std::string> Drawn(std::vector<std::string> rows, bool wraps = false) {
  const VoidMap map = MapOf(rows, wraps);
  for (size_t y = 0; y < rows.size(); ++y) {
    for (size_t x = 0; x < rows[y].size(); ++x) {
      if (map.Holds(static_cast<int>(x), static_cast<int>(y))) rows[y][x] = 'v';
    }
  }
  return rows;
}

TEST(VoidMap, WhatReachesAnEdgeIsNoVoid) {
  using Rows = std::vector<std::string>;
  EXPECT_EQ(Drawn({"####", "#..#", "####"}), (Rows{"####", "#vv#", "####"}));
  EXPECT_EQ(Drawn({"####", "#..#", "##.#"}), (Rows{"####", "#..#", "##.#"}));
  EXPECT_EQ(Drawn({".###", "#.##", "####"}), (Rows{".###", "#v##", "####"})) << "joined along sides, not over corners";
  // Arms that join only at the bottom, one of which leads out; and an island with a void in a void.
  EXPECT_EQ(Drawn({"##.####", "#.#.###", "#.#.###", "#...###", "#######"}),
            (Rows{"##.####", "#v#v###", "#v#v###", "#vvv###", "#######"}));
  EXPECT_EQ(Drawn({"#######", "#.....#", "#.###.#", "#.#.#.#", "#.###.#", "#.....#", "#######"}),
            (Rows{"#######", "#vvvvv#", "#v###v#", "#v#v#v#", "#v###v#", "#vvvvv#", "#######"}));
}

TEST(VoidMap, WhatClosesOnItselfHasNoEdgeAtTheSeam) {
  using Rows = std::vector<std::string>;
  const Rows rows{"#####", ".###.", "#####"};
  EXPECT_EQ(Drawn(rows, false), rows);
  EXPECT_EQ(Drawn(rows, true), (Rows{"#####", "v###v", "#####"}));
  EXPECT_TRUE(MapOf({"###", "###"}).empty());
  EXPECT_FALSE(MapOf({"###", "#.#", "###"}).Holds(1, -1));
  EXPECT_FALSE(MapOf({"###", "#.#", "###"}).Holds(1, 3));
}

TEST(VoidMap, AgreesWithFloodingFromTheEdges) {
  std::mt19937 random(3);
  constexpr int kSide = 60;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::string> rows(kSide, std::string(kSide, '#'));
    for (std::string& row : rows) {
      for (char& c : row) c = random() % 20 < 11 ? '.' : '#';
    }
    std::vector<std::string> flooded = rows;
    std::vector<std::pair<int, int>> open;
    for (int i = 0; i < kSide; ++i) {
      for (const auto& at : {std::pair{i, 0}, {i, kSide - 1}, {0, i}, {kSide - 1, i}}) open.push_back(at);
    }
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      if (x < 0 || y < 0 || x >= kSide || y >= kSide) continue;
      char& c = flooded[static_cast<size_t>(y)][static_cast<size_t>(x)];
      if (c != '.') continue;
      c = 'o';
      for (const auto& at : {std::pair{x + 1, y}, {x - 1, y}, {x, y + 1}, {x, y - 1}}) open.push_back(at);
    }
    for (std::string& row : flooded) {
      for (char& c : row) c = c == '.' ? 'v' : c == 'o' ? '.' : c;
    }
    EXPECT_EQ(Drawn(rows), flooded);
  }
}

}  // namespace
}  // namespace belvedere

// Features cut along a line of the grid, and with fewer points.
#include "preproc/vectors/clip.h"

#include "preproc/vectors/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace belvedere {
namespace {

double LengthOf(const FeatureParts& parts) {
  double length = 0;
  for (const FeaturePart& part : parts) {
    for (size_t i = 1; i < part.size(); ++i)
      length +=
          std::hypot(static_cast<double>(part[i].x - part[i - 1].x), static_cast<double>(part[i].y - part[i - 1].y));
  }
  return length;
}

double AreaOf(const FeatureParts& rings) {
  double twice = 0;
  for (const FeaturePart& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const GridPlace &a = ring[i], &b = ring[(i + 1) % ring.size()];
      twice +=
          static_cast<double>(a.x) * static_cast<double>(b.y) - static_cast<double>(b.x) * static_cast<double>(a.y);
    }
  }
  return std::abs(twice) / 2;
}

FeaturePart RandomWalk(std::mt19937& random, int points, int64_t stride) {
  FeaturePart part{{0, 0}};
  std::uniform_int_distribution<int64_t> step(-stride, stride);
  while (static_cast<int>(part.size()) < points) {
    const GridPlace next{part.back().x + step(random), part.back().y + step(random)};
    if (next != part.back()) part.push_back(next);
  }
  return part;
}

TEST(Clip, BothSidesOfALineMeetInOnePoint) {
  const auto [west, east] = CutInTwo({{{-10, 0}, {20, 30}}}, FeatureShape::kLines, GridAxis::kX, 0);
  ASSERT_EQ(west, (FeatureParts{{{-10, 0}, {0, 10}}}));
  ASSERT_EQ(east, (FeatureParts{{{0, 10}, {20, 30}}}));
}

TEST(Clip, LinesKeepTheirLengthAndTheirSides) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const FeaturePart line = RandomWalk(random, 40, 100000);
    const GridAxis axis = i % 2 == 0 ? GridAxis::kX : GridAxis::kY;
    const auto sides = CutInTwo({line}, FeatureShape::kLines, axis, 0);
    // A crossing is rounded to the grid.
    EXPECT_NEAR(LengthOf(sides[0]) + LengthOf(sides[1]), LengthOf({line}), 40);
    for (size_t side = 0; side < 2; ++side) {
      for (const FeaturePart& part : sides[side]) {
        ASSERT_GE(part.size(), 2u);
        for (const GridPlace& place : part) {
          const int64_t along = axis == GridAxis::kX ? place.x : place.y;
          ASSERT_TRUE(side == 0 ? along <= 0 : along >= 0);
        }
      }
    }
  }
}

// Neighbours cut the same line each for itself: by their own borders, in any order, from either end.
TEST(Clip, ACrossingIsTheSameFromBothEnds) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int64_t> place(-1000000, 1000000);
  for (int i = 0; i < 2000; ++i) {
    const GridPlace a{place(random), place(random)}, b{place(random), place(random)};
    const auto there = CutInTwo({{a, b}}, FeatureShape::kLines, GridAxis::kX, 12345);
    const auto back = CutInTwo({{b, a}}, FeatureShape::kLines, GridAxis::kX, 12345);
    for (size_t side = 0; side < 2; ++side) {
      ASSERT_EQ(there[side].size(), back[side].size());
      if (there[side].empty()) continue;
      FeaturePart reversed = back[side][0];
      std::reverse(reversed.begin(), reversed.end());
      ASSERT_EQ(there[side][0], reversed);
    }
  }
}

TEST(Clip, WhatRunsAlongTheLineBelongsEast) {
  const auto [west, east] = CutInTwo({{{0, 0}, {0, 9}}}, FeatureShape::kLines, GridAxis::kX, 0);
  EXPECT_TRUE(west.empty());
  EXPECT_EQ(east.size(), 1u);
  const auto points = CutInTwo({{{0, 0}, {-1, 3}}}, FeatureShape::kPoints, GridAxis::kX, 0);
  EXPECT_EQ(points[0], (FeatureParts{{{-1, 3}}}));
  EXPECT_EQ(points[1], (FeatureParts{{{0, 0}}}));
}

TEST(Clip, PolygonsKeepTheirArea) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> radius(1000, 90000);
  for (int i = 0; i < 300; ++i) {
    FeaturePart ring;
    for (int corner = 0; corner < 30; ++corner) {
      const double angle = corner * 2 * 3.14159265 / 30, r = radius(random);
      ring.push_back({std::llround(r * std::cos(angle)), std::llround(r * std::sin(angle))});
    }
    const auto sides =
        CutInTwo({ring}, FeatureShape::kPolygons, i % 2 == 0 ? GridAxis::kX : GridAxis::kY, 700 * (i % 9));
    EXPECT_NEAR(AreaOf(sides[0]) + AreaOf(sides[1]), AreaOf({ring}), 1e-4 * AreaOf({ring}));
  }
}

TEST(Clip, ARingThatOnlyTouchesIsWhole) {
  const FeaturePart ring{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const auto [west, east] = CutInTwo({ring}, FeatureShape::kPolygons, GridAxis::kX, 0);
  EXPECT_TRUE(west.empty());
  EXPECT_EQ(east, FeatureParts{ring});
}

double DistanceTo(const FeaturePart& line, const GridPlace& place) {
  double least = 1e300;
  for (size_t i = 1; i < line.size(); ++i) {
    const auto x = static_cast<double>(line[i].x - line[i - 1].x), y = static_cast<double>(line[i].y - line[i - 1].y);
    const auto px = static_cast<double>(place.x - line[i - 1].x), py = static_cast<double>(place.y - line[i - 1].y);
    const double t = std::clamp((px * x + py * y) / (x * x + y * y), 0.0, 1.0);
    least = std::min(least, std::hypot(px - t * x, py - t * y));
  }
  return least;
}

TEST(Simplify, NoPointIsFurtherOffThanTheTolerance) {
  std::mt19937 random(4);
  const auto none = [](const GridPlace&) { return false; };
  for (int i = 0; i < 100; ++i) {
    const FeaturePart line = RandomWalk(random, 200, 1000);
    const double tolerance = 200.0 * (1 + i % 10);
    const Simplified simple = Simplify(line, FeatureShape::kLines, tolerance, none);
    EXPECT_EQ(simple.part.front(), line.front());
    EXPECT_EQ(simple.part.back(), line.back());
    EXPECT_LT(simple.part.size(), line.size());
    EXPECT_LE(simple.deviation, tolerance);
    for (const GridPlace& place : line) ASSERT_LE(DistanceTo(simple.part, place), simple.deviation + 1e-6);
  }
}

TEST(Simplify, KeepsWhatItIsTold) {
  const FeaturePart line{{0, 0}, {5, 0}, {9, 0}, {20, 0}};
  const auto nine = [](const GridPlace& place) { return place.x == 9; };
  EXPECT_EQ(Simplify(line, FeatureShape::kLines, 3, nine).part, (FeaturePart{{0, 0}, {9, 0}, {20, 0}}));
  EXPECT_EQ(Simplify(line, FeatureShape::kLines, 0, nine).part, line) << "a tolerance of 0 changes nothing";
}

TEST(Simplify, RingsStayRingsOrGo) {
  FeaturePart circle;
  for (int i = 0; i < 360; ++i)
    circle.push_back({std::llround(10000 * std::cos(i * 0.0174533)), std::llround(10000 * std::sin(i * 0.0174533))});
  const auto none = [](const GridPlace&) { return false; };
  const Simplified coarse = Simplify(circle, FeatureShape::kPolygons, 500, none);
  EXPECT_GE(coarse.part.size(), 8u);
  EXPECT_LT(coarse.part.size(), 40u);
  EXPECT_NEAR(AreaOf({coarse.part}), AreaOf({circle}), 0.12 * AreaOf({circle}));
  EXPECT_TRUE(Simplify(circle, FeatureShape::kPolygons, 30000, none).part.empty());
}

}  // namespace
}  // namespace belvedere

#include "preproc/surface_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace belvedere {
namespace {

// Height of a page's triangles at (x, y) in cells, with the diagonals that surface_error.h describes.
double TriangleHeight(const ElevationPage& page, double x, double y) {
  const int i = std::min(static_cast<int>(x), kCells - 1);
  const int j = std::min(static_cast<int>(y), kCells - 1);
  const double u = x - i, v = y - j;
  const double sw = page.at(i, j), se = page.at(i + 1, j), nw = page.at(i, j + 1), ne = page.at(i + 1, j + 1);
  if ((i + j) % 2 == 0) {
    return (u >= v ? sw + u * (se - sw) + v * (ne - se) : sw + v * (nw - sw) + u * (ne - nw)) / 1000.0;
  }
  return (u + v <= 1 ? sw + u * (se - sw) + v * (nw - sw) : ne + (1 - u) * (nw - ne) + (1 - v) * (se - ne)) / 1000.0;
}

std::shared_ptr<ElevationPage> Rough(std::mt19937& random) {
  auto page = std::make_shared<ElevationPage>();
  for (int i = 0; i < kElevationSide * kElevationSide; ++i)
    page->heights_mm.push_back(static_cast<int32_t>(random() % 2000000));
  return page;
}

BoundedPage Finest(std::shared_ptr<ElevationPage> page) {
  CellDeviations deviations = BoundPage(*page, nullptr);
  return {std::move(page), std::move(deviations)};
}

TEST(SurfaceError, BoundsEveryPointOfTheFinestSurface) {
  std::mt19937 random(11);
  auto root = Rough(random);
  std::array<BoundedPage, 4> children;
  std::array<BoundedPage, 4> grandchildren;  // of child 2
  for (auto& page : grandchildren) {
    page = Finest(Rough(random));
    EXPECT_EQ(page.page->error_m, 0.0f);
  }
  for (size_t which = 0; which < 4; ++which) {
    auto made = Rough(random);
    children[which].deviations = BoundPage(*made, which == 2 ? &grandchildren : nullptr);
    children[which].page = made;
  }
  BoundPage(*root, &children);
  std::uniform_real_distribution<double> unit(0, 1);
  double largest = 0;
  std::vector<double> by_block(root->block_errors_m.size(), 0.0);
  for (int n = 0; n < 400000; ++n) {
    const double x = kCells * unit(random), y = kCells * unit(random);
    const double coarse = TriangleHeight(*root, x, y);
    const int which = (x >= kCells / 2 ? 1 : 0) + (y >= kCells / 2 ? 2 : 0);
    const double cx = 2 * x - (which % 2) * kCells, cy = 2 * y - (which / 2) * kCells;
    double fine = TriangleHeight(*children[static_cast<size_t>(which)].page, cx, cy);
    if (which == 2) {
      const int below = (cx >= kCells / 2 ? 1 : 0) + (cy >= kCells / 2 ? 2 : 0);
      fine = TriangleHeight(*grandchildren[static_cast<size_t>(below)].page, 2 * cx - (below % 2) * kCells,
                            2 * cy - (below / 2) * kCells);
    }
    double& in_block =
        by_block[static_cast<size_t>(y / kBlockCells) * kErrorBlocks + static_cast<size_t>(x / kBlockCells)];
    in_block = std::max(in_block, std::abs(fine - coarse));
    largest = std::max(largest, in_block);
  }
  for (size_t block = 0; block < by_block.size(); ++block) {
    EXPECT_LE(by_block[block], static_cast<double>(root->block_errors_m[block]));
    EXPECT_LE(root->block_errors_m[block], root->error_m);
  }
  EXPECT_LE(largest, static_cast<double>(root->error_m));
  EXPECT_GT(largest, static_cast<double>(root->error_m) / 3) << "the bound is far from what it bounds";
}

// With one level below, the bound of a block is what a search through all the posts under it finds.
TEST(SurfaceError, IsTheLargestDistanceAtPostsOfEachBlock) {
  std::mt19937 random(12);
  const auto parent = Rough(random);
  std::array<BoundedPage, 4> children;
  for (BoundedPage& child : children) child = Finest(Rough(random));
  BoundPage(*parent, &children);
  for (int block = 0; block < kErrorBlocks * kErrorBlocks; ++block) {
    double largest = 0;
    for (int row = 2 * (block / kErrorBlocks) * kBlockCells; row <= 2 * (block / kErrorBlocks + 1) * kBlockCells;
         ++row) {
      for (int column = 2 * (block % kErrorBlocks) * kBlockCells;
           column <= 2 * (block % kErrorBlocks + 1) * kBlockCells; ++column) {
        // A post on the line between two children is looked up in the one whose block it bounds.
        const int east = 2 * (block % kErrorBlocks) * kBlockCells >= kCells ? 1 : 0;
        const int north = 2 * (block / kErrorBlocks) * kBlockCells >= kCells ? 1 : 0;
        const ElevationPage& child = *children[static_cast<size_t>(2 * north + east)].page;
        const double height_m = child.at(column - east * kCells, row - north * kCells) / 1000.0;
        largest = std::max(largest, std::abs(height_m - TriangleHeight(*parent, column / 2.0, row / 2.0)));
      }
    }
    EXPECT_NEAR(parent->block_errors_m[static_cast<size_t>(block)], largest, 1e-3);
  }
}

// What one level raises and the next lowers again does not count twice.
TEST(SurfaceError, WhatTheNextLevelTakesBackIsNotAdded) {
  const auto flat = [](int32_t height_mm) {
    auto page = std::make_shared<ElevationPage>();
    page->heights_mm.assign(static_cast<size_t>(kElevationSide) * kElevationSide, height_mm);
    return page;
  };
  auto root = flat(0);
  std::array<BoundedPage, 4> children, grandchildren;
  for (BoundedPage& page : grandchildren) page = Finest(flat(20'000));
  for (BoundedPage& child : children) {
    auto page = flat(100'000);
    child.deviations = BoundPage(*page, &grandchildren);
    EXPECT_EQ(page->error_m, 80.0f);
    child.page = page;
  }
  BoundPage(*root, &children);
  EXPECT_EQ(root->error_m, 20.0f);
}

// One cliff in a far corner leaves the other blocks as good as they are.
TEST(SurfaceError, ACliffCountsForItsBlockAlone) {
  auto page = std::make_shared<ElevationPage>();
  page->heights_mm.assign(static_cast<size_t>(kElevationSide) * kElevationSide, 0);
  std::array<BoundedPage, 4> children;
  for (size_t which = 0; which < 4; ++which) {
    auto made = std::make_shared<ElevationPage>(*page);
    if (which == 1) made->heights_mm[static_cast<size_t>((3 + kApron) * kElevationSide + 100 + kApron)] = 700000;
    children[which] = Finest(made);
  }
  BoundPage(*page, &children);
  EXPECT_EQ(page->error_m, 700.0f);
  const size_t cliff = (64 + 100 / 2) / kBlockCells;  // in the lowest row of blocks
  for (size_t block = 0; block < page->block_errors_m.size(); ++block) {
    EXPECT_EQ(page->block_errors_m[block], block == cliff ? 700.0f : 0.0f) << block;
  }
}

TEST(SurfaceError, ExtremesIncludeWhatIsFiner) {
  std::mt19937 random(13);
  auto page = Rough(random);
  std::array<BoundedPage, 4> children;
  for (size_t which = 0; which < 4; ++which) {
    auto made = Rough(random);
    if (which == 3) made->heights_mm[static_cast<size_t>((40 + kApron) * kElevationSide + 9)] = 8848860;
    if (which == 1) made->heights_mm[static_cast<size_t>((4 + kApron) * kElevationSide + 70)] = -10994000;
    children[which] = Finest(made);
  }
  BoundPage(*page, &children);
  EXPECT_GE(page->max_m, 8848.86f);
  EXPECT_LE(page->min_m, -10994.0f);
  EXPECT_LT(page->max_m, 8848.87f);
}

// At the south pole a page has a child at the pole, and one beside it, each as wide as itself.
TEST(SurfaceError, HalvesOfAWideChildSayHowFarItsTrianglesAreFromTheirs) {
  std::mt19937 random(12);
  const Quadcode pole = Quadcode::Root(3).Child(0);
  std::array<BoundedPage, 4> children;
  const auto wide = Rough(random);
  for (const int which : pole.Children()) {
    EXPECT_TRUE(IsWide(pole, static_cast<size_t>(which)));
    children[static_cast<size_t>(which)] = Finest(wide);
  }
  HalveWide(pole, children);
  std::uniform_real_distribution<double> unit(0, 1);
  double closest_m = 1e9;
  for (int n = 0; n < 200000; ++n) {
    const double x = kCells * unit(random), y = kCells * unit(random);
    const size_t half = x >= kCells / 2 ? 1 : 0;
    const double own_x = 2 * x - static_cast<double>(half) * kCells;
    const BoundedPage& child = children[half];
    const auto cell = static_cast<size_t>(y) * kCells + static_cast<size_t>(own_x);
    const double off_m = TriangleHeight(*wide, x, y) - TriangleHeight(*child.page, own_x, y);
    const double low_m = child.deviations[cell].low * kMetresPerDeviation;
    const double high_m = child.deviations[cell].high * kMetresPerDeviation;
    ASSERT_GE(off_m, low_m) << x << " " << y;
    ASSERT_LE(off_m, high_m) << x << " " << y;
    if (high_m > 10) closest_m = std::min(closest_m, (high_m - std::abs(off_m)) / high_m);
  }
  EXPECT_LT(closest_m, 0.05) << "what is promised is reached somewhere";
}

TEST(SurfaceError, FarFromThePolesNoChildIsHalved) {
  std::mt19937 random(13);
  const Quadcode node = Quadcode::Containing(40, 10, 6);
  std::array<BoundedPage, 4> children;
  for (auto& child : children) child = Finest(Rough(random));
  const std::array<BoundedPage, 4> before = children;
  HalveWide(node, children);
  for (size_t which = 0; which < 4; ++which) EXPECT_EQ(children[which].page, before[which].page);
}

}  // namespace
}  // namespace belvedere

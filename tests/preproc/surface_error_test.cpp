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

TEST(SurfaceError, BoundsEveryPointOfEveryFinerSurface) {
  std::mt19937 random(11);
  auto root = Rough(random);
  std::array<std::shared_ptr<const ElevationPage>, 4> children;
  std::array<std::shared_ptr<const ElevationPage>, 4> grandchildren;  // of child 2
  for (auto& page : grandchildren) {
    auto made = Rough(random);
    BoundPage(*made, nullptr);
    EXPECT_EQ(made->error_m, 0.0f);
    page = made;
  }
  for (size_t which = 0; which < 4; ++which) {
    auto made = Rough(random);
    BoundPage(*made, which == 2 ? &grandchildren : nullptr);
    children[which] = made;
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
    double fine = TriangleHeight(*children[static_cast<size_t>(which)], cx, cy);
    double& in_block =
        by_block[static_cast<size_t>(y / kBlockCells) * kErrorBlocks + static_cast<size_t>(x / kBlockCells)];
    in_block = std::max(in_block, std::abs(fine - coarse));
    largest = std::max(largest, in_block);
    const auto block =
        static_cast<size_t>(static_cast<int>(y) / kBlockCells * kErrorBlocks + static_cast<int>(x) / kBlockCells);
    ASSERT_LE(std::abs(fine - coarse), static_cast<double>(root->block_errors_m[block]));
    if (which != 2) continue;
    const int below = (cx >= kCells / 2 ? 1 : 0) + (cy >= kCells / 2 ? 2 : 0);
    fine = TriangleHeight(*grandchildren[static_cast<size_t>(below)], 2 * cx - (below % 2) * kCells,
                          2 * cy - (below / 2) * kCells);
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

TEST(SurfaceError, IsTheLargestDistanceAtPostsOfEachBlock) {
  std::mt19937 random(12);
  const auto parent = Rough(random);
  const auto child = Rough(random);
  for (int which = 0; which < 4; ++which) {
    const auto distances = DistanceFromParent(*parent, *child, which);
    for (int block = 0; block < kErrorBlocks * kErrorBlocks; ++block) {
      double largest = 0;
      for (int row = block / kErrorBlocks * kBlockCells; row <= (block / kErrorBlocks + 1) * kBlockCells; ++row) {
        for (int column = block % kErrorBlocks * kBlockCells; column <= (block % kErrorBlocks + 1) * kBlockCells;
             ++column) {
          const double x = (which % 2 * kCells + column) / 2.0, y = (which / 2 * kCells + row) / 2.0;
          largest = std::max(largest, std::abs(child->at(column, row) / 1000.0 - TriangleHeight(*parent, x, y)));
        }
      }
      EXPECT_NEAR(distances[static_cast<size_t>(block)], largest, 1e-6);
    }
  }
}

// One cliff in a far corner leaves the other blocks as good as they are.
TEST(SurfaceError, ACliffCountsForItsBlockAlone) {
  auto page = std::make_shared<ElevationPage>();
  page->heights_mm.assign(static_cast<size_t>(kElevationSide) * kElevationSide, 0);
  std::array<std::shared_ptr<const ElevationPage>, 4> children;
  for (size_t which = 0; which < 4; ++which) {
    auto made = std::make_shared<ElevationPage>(*page);
    if (which == 1) made->heights_mm[static_cast<size_t>((3 + kApron) * kElevationSide + 100 + kApron)] = 700000;
    BoundPage(*made, nullptr);
    children[which] = made;
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
  std::array<std::shared_ptr<const ElevationPage>, 4> children;
  for (size_t which = 0; which < 4; ++which) {
    auto made = Rough(random);
    if (which == 3) made->heights_mm[static_cast<size_t>((40 + kApron) * kElevationSide + 9)] = 8848860;
    if (which == 1) made->heights_mm[static_cast<size_t>((4 + kApron) * kElevationSide + 70)] = -10994000;
    BoundPage(*made, nullptr);
    children[which] = made;
  }
  BoundPage(*page, &children);
  EXPECT_GE(page->max_m, 8848.86f);
  EXPECT_LE(page->min_m, -10994.0f);
  EXPECT_LT(page->max_m, 8848.87f);
}

TEST(SurfaceError, ShareBeyondCountsProbes) {
  ElevationPage flat;
  flat.heights_mm.assign(static_cast<size_t>(kElevationSide) * kElevationSide, 5000);
  std::vector<double> probes(32 * 32, 5.0);
  EXPECT_EQ(ShareBeyond(flat, probes, 1.0), 0.0);
  for (size_t i = 0; i < 256; ++i) probes[i] = 7.0;
  EXPECT_EQ(ShareBeyond(flat, probes, 1.0), 0.25);
  EXPECT_EQ(ShareBeyond(flat, probes, 2.5), 0.0);
}

}  // namespace
}  // namespace belvedere

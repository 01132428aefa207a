#include "preproc/surface_error.h"

#include "preproc/lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace belvedere {
namespace {

// Twice the height of the parent's triangles at half-post (u, v): a post, the middle of an edge or of a diagonal.
int64_t TwiceHeight(const ElevationPage& page, int u, int v) {
  const int i = u / 2;
  const int j = v / 2;
  if (u % 2 == 0 && v % 2 == 0) return 2 * int64_t{page.at(i, j)};
  if (v % 2 == 0) return int64_t{page.at(i, j)} + page.at(i + 1, j);
  if (u % 2 == 0) return int64_t{page.at(i, j)} + page.at(i, j + 1);
  if ((i + j) % 2 == 0) return int64_t{page.at(i, j)} + page.at(i + 1, j + 1);
  return int64_t{page.at(i + 1, j)} + page.at(i, j + 1);
}

// The nearest floats that are not inside of the value.
float RoundedUp(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                              : rounded;
}
float RoundedDown(double value) {
  return -RoundedUp(-value);
}

}  // namespace

std::array<double, ErrorBlocks{}.size()> DistanceFromParent(const ElevationPage& parent, const ElevationPage& child,
                                                            int which) {
  const int west = which % 2 * kCells;
  const int south = which / 2 * kCells;
  std::array<double, ErrorBlocks{}.size()> distances{};
  for (int block = 0; block < kErrorBlocks * kErrorBlocks; ++block) {
    const int first_row = block / kErrorBlocks * kBlockCells;
    const int first_column = block % kErrorBlocks * kBlockCells;
    int64_t largest = 0;
    // A post on the line between blocks belongs to both.
    for (int row = first_row; row <= first_row + kBlockCells; ++row) {
      for (int column = first_column; column <= first_column + kBlockCells; ++column) {
        const int64_t twice = 2 * int64_t{child.at(column, row)} - TwiceHeight(parent, west + column, south + row);
        largest = std::max(largest, std::abs(twice));
      }
    }
    distances[static_cast<size_t>(block)] = static_cast<double>(largest) / 2000.0;
  }
  return distances;
}

void BoundPage(ElevationPage& page, const std::array<std::shared_ptr<const ElevationPage>, 4>* children) {
  int32_t lowest = page.at(0, 0), highest = page.at(0, 0);
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      lowest = std::min(lowest, page.at(column, row));
      highest = std::max(highest, page.at(column, row));
    }
  }
  page.min_m = RoundedDown(lowest / 1000.0);
  page.max_m = RoundedUp(highest / 1000.0);
  page.error_m = 0;
  page.block_errors_m.fill(0);
  if (children == nullptr) return;
  for (int which = 0; which < 4; ++which) {
    const ElevationPage& child = *(*children)[static_cast<size_t>(which)];
    page.min_m = std::min(page.min_m, child.min_m);
    page.max_m = std::max(page.max_m, child.max_m);
    const auto distances = DistanceFromParent(page, child, which);
    for (size_t block = 0; block < distances.size(); ++block) {
      // Two by two blocks of the child lie under one of the parent.
      const size_t x = (static_cast<size_t>(which) % 2 * kErrorBlocks + block % kErrorBlocks) / 2;
      const size_t y = (static_cast<size_t>(which) / 2 * kErrorBlocks + block / kErrorBlocks) / 2;
      float& own = page.block_errors_m[y * kErrorBlocks + x];
      own = std::max(own, RoundedUp(static_cast<double>(child.block_errors_m[block]) + distances[block]));
      page.error_m = std::max(page.error_m, own);
    }
  }
}

double ShareBeyond(const ElevationPage& page, const std::vector<double>& probe_heights_m, double tolerance_m) {
  size_t probe = 0, beyond = 0;
  for (int row = kProbeFirst; row < kCells; row += kProbeStep) {
    for (int column = kProbeFirst; column < kCells; column += kProbeStep) {
      const double sum = static_cast<double>(page.at(column, row)) + page.at(column + 1, row) +
                         page.at(column, row + 1) + page.at(column + 1, row + 1);
      if (std::abs(sum / 4000.0 - probe_heights_m[probe++]) > tolerance_m) ++beyond;
    }
  }
  return static_cast<double>(beyond) / static_cast<double>(probe);
}

}  // namespace belvedere

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

// Heights of the child over the parent's triangles at its posts, twice, millimetres.
std::vector<int64_t> TwiceOverParent(const ElevationPage& parent, const ElevationPage& child, int which) {
  const int west = which % 2 * kCells;
  const int south = which / 2 * kCells;
  std::vector<int64_t> over;
  over.reserve(static_cast<size_t>(kPosts) * kPosts);
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      over.push_back(2 * int64_t{child.at(column, row)} - TwiceHeight(parent, west + column, south + row));
    }
  }
  return over;
}

// Widens the cells of the parent by what lies under them in the child `which`, cell by cell of the child.
void AddChild(const ElevationPage& parent, const BoundedPage& child, int which, CellDeviations& parents) {
  const std::vector<int64_t> over = TwiceOverParent(parent, *child.page, which);
  const int west = which % 2 * kCells;
  const int south = which / 2 * kCells;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const auto corner = static_cast<size_t>(row * kPosts + column);
      const auto [lowest, highest] =
          std::minmax({over[corner], over[corner + 1], over[corner + kPosts], over[corner + kPosts + 1]});
      const Deviation& own = child.deviations[static_cast<size_t>(row * kCells + column)];
      Deviation& cell = parents[static_cast<size_t>((south + row) / 2 * kCells + (west + column) / 2)];
      cell.low = std::min(cell.low, own.low + lowest);
      cell.high = std::max(cell.high, own.high + highest);
    }
  }
}

}  // namespace

CellDeviations BoundPage(ElevationPage& page, const std::array<BoundedPage, 4>* children) {
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
  CellDeviations deviations(static_cast<size_t>(kCells) * kCells);
  if (children == nullptr) return deviations;
  deviations.assign(deviations.size(), {std::numeric_limits<int64_t>::max(), std::numeric_limits<int64_t>::min()});
  for (size_t which = 0; which < children->size(); ++which) {
    const BoundedPage& child = (*children)[which];
    page.min_m = std::min(page.min_m, child.page->min_m);
    page.max_m = std::max(page.max_m, child.page->max_m);
    AddChild(page, child, static_cast<int>(which), deviations);
  }
  for (size_t cell = 0; cell < deviations.size(); ++cell) {
    const size_t block = cell / kCells / kBlockCells * kErrorBlocks + cell % kCells / kBlockCells;
    float& error = page.block_errors_m[block];
    error = std::max(error, RoundedUp(static_cast<double>(std::max(deviations[cell].high, -deviations[cell].low)) *
                                      kMetresPerDeviation));
    page.error_m = std::max(page.error_m, error);
  }
  return deviations;
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

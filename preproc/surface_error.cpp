#include "preproc/surface_error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace belvedere {
namespace {

// The nearest floats that are not inside of the value.
float RoundedUp(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                              : rounded;
}
float RoundedDown(double value) {
  return -RoundedUp(-value);
}

using ChildRow = std::array<int32_t, kPosts>;  // half-millimetres, at a child's posts

// Heights of the child `which` over the parent's triangles at its posts of that row: posts of the parent, middles of
// edges and, by turns, of diagonals that rise and fall.
void FillOverParent(const ElevationPage& parent, const ElevationPage& child, int which, int row, ChildRow& over) {
  const int first = which % 2 * kCells / 2;
  const int v = which / 2 * kCells + row;  // half-posts of the parent
  const auto row_of = [](const ElevationPage& page, int column, int at) {
    return &page.heights_mm[static_cast<size_t>((at + kApron) * kElevationSide + column + kApron)];
  };
  const int32_t* own = row_of(child, 0, row);
  const int32_t* south = row_of(parent, first, v / 2);
  const int32_t* north = v % 2 == 0 ? south : row_of(parent, first, v / 2 + 1);
  for (int i = 0; i < kCells / 2; ++i) {
    over[static_cast<size_t>(2 * i)] = 2 * own[2 * i] - south[i] - north[i];
    const bool rises = (first + i + v / 2) % 2 == 0;
    const int32_t middle = rises ? south[i] + north[i + 1] : south[i + 1] + north[i];
    over[static_cast<size_t>(2 * i + 1)] = 2 * own[2 * i + 1] - middle;
  }
  over[kCells] = 2 * own[kCells] - south[kCells / 2] - north[kCells / 2];
}

// Widens the cells of the parent by what lies under them in the child `which`, cell by cell of the child.
void AddChild(const ElevationPage& parent, const BoundedPage& child, int which, CellDeviations& parents) {
  ChildRow south, north, lowest, highest;
  FillOverParent(parent, *child.page, which, 0, south);
  for (size_t row = 0; row < kCells; ++row) {
    FillOverParent(parent, *child.page, which, static_cast<int>(row) + 1, north);
    for (size_t i = 0; i < kPosts; ++i) {
      lowest[i] = std::min(south[i], north[i]);
      highest[i] = std::max(south[i], north[i]);
    }
    const Deviation* own = &child.deviations[row * kCells];
    const size_t first =
        (static_cast<size_t>(which) / 2 * kCells + row) / 2 * kCells + static_cast<size_t>(which) % 2 * kCells / 2;
    for (size_t column = 0; column < kCells; ++column) {
      Deviation& cell = parents[first + column / 2];
      cell.low = std::min(cell.low, own[column].low + std::min(lowest[column], lowest[column + 1]));
      cell.high = std::max(cell.high, own[column].high + std::max(highest[column], highest[column + 1]));
    }
    std::swap(south, north);
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
  deviations.assign(deviations.size(), {std::numeric_limits<int32_t>::max(), std::numeric_limits<int32_t>::min()});
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

}  // namespace belvedere

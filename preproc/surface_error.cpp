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

// east: 0 for the western half, 1 for the eastern.
BoundedPage HalfOf(const BoundedPage& wide, int east) {
  const ElevationPage& page = *wide.page;
  auto half = std::make_shared<ElevationPage>(page);
  BoundedPage out{half, CellDeviations(wide.deviations.size()), wide.depth};
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      const int west_of = (east * kCells + column) / 2;
      const int32_t west_mm = page.at(west_of, row);
      half->heights_mm[static_cast<size_t>((row + kApron) * kElevationSide + column + kApron)] =
          column % 2 == 0 ? west_mm : static_cast<int32_t>((int64_t{west_mm} + page.at(west_of + 1, row)) / 2);
    }
  }
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const int from = (east * kCells + column) / 2;
      // Of the four corners of a cell one is so far off the plane of the others; cut anew in two, its surface moves by
      // a third of that at most. Heights half-way are rounded besides.
      const int64_t twist_mm =
          int64_t{page.at(from, row)} + page.at(from + 1, row + 1) - page.at(from + 1, row) - page.at(from, row + 1);
      const auto off = static_cast<int32_t>((2 * std::abs(twist_mm) + 2) / 3 + 1);
      const Deviation& whole = wide.deviations[static_cast<size_t>(row * kCells + from)];
      out.deviations[static_cast<size_t>(row * kCells + column)] = {whole.low - off, whole.high + off};
    }
  }
  return out;
}

}  // namespace

bool IsWide(Quadcode node, size_t child) {
  return node.Child(static_cast<int>(child & ~size_t{1})).GridWidth() == node.GridWidth();
}

void HalveWide(Quadcode node, std::array<BoundedPage, 4>& children) {
  for (const size_t west : {size_t{0}, size_t{2}}) {
    if (!IsWide(node, west)) continue;
    children[west + 1] = HalfOf(children[west], 1);
    children[west] = HalfOf(children[west], 0);
  }
}

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

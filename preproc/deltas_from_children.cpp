#include "preproc/deltas_from_children.h"

#include "runtime/base/status.h"
#include "runtime/earth/post_grid.h"
#include "runtime/paging/delta_values.h"
#include "runtime/paging/stored_deltas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace belvedere {
namespace {

constexpr int kSide = FinestSurface::kSide;

float OverBase(int32_t height_mm, int32_t base_mm) {
  return static_cast<float>(static_cast<double>(int64_t{height_mm} - base_mm) * kMetresPerMillimetre);
}

// A child's cells say how far the finest surface is from their triangles, but for the Earth's curvature, which raises
// it by the sagitta at most. A point takes it from the cells that meet there.
void WidenByCells(const BoundedPage& child, size_t corner, int32_t sagitta, std::vector<Deviation>& around) {
  for (size_t row = 0; row < kCells; ++row) {
    for (size_t column = 0; column < kCells; ++column) {
      const Deviation& cell = child.deviations[row * kCells + column];
      const size_t at = corner + row * kSide + column;
      for (const size_t point : {at, at + 1, at + kSide, at + kSide + 1}) {
        around[point].low = std::min(around[point].low, cell.low);
        around[point].high = std::max(around[point].high, cell.high + sagitta);
      }
    }
  }
}

// Heights over base_mm.
FinestSurface FinestUnder(Quadcode node, const std::array<BoundedPage, 4>& children, int32_t base_mm) {
  FinestSurface finest;
  finest.low_m.resize(static_cast<size_t>(kSide) * kSide);
  std::vector<Deviation> around(finest.low_m.size());
  for (size_t which = 0; which < children.size(); ++which) {
    const BoundedPage& child = children[which];
    const size_t corner = which / 2 * kCells * kSide + which % 2 * kCells;
    for (int row = 0; row < kPosts; ++row) {
      for (int column = 0; column < kPosts; ++column) {
        finest.low_m[corner + static_cast<size_t>(row * kSide + column)] =
            OverBase(child.page->at(column, row), base_mm);
      }
    }
    const bool is_finest = child.page->deltas.steps.empty();
    const bool is_half = IsWide(node, which);
    if (is_finest && !is_half) continue;
    // Of what is finer than its cells. Halves are of the child in the western one's place.
    const auto of = static_cast<int>(is_half ? which & ~size_t{1} : which);
    const double sagitta_m = is_finest ? 0 : CellSagitta(node.Child(of));
    WidenByCells(child, corner, static_cast<int32_t>(std::ceil(sagitta_m / kMetresPerDeviation)), around);
  }
  finest.high_m = finest.low_m;
  for (size_t point = 0; point < around.size(); ++point) {
    finest.low_m[point] += static_cast<float>(static_cast<double>(around[point].low) * kMetresPerDeviation);
    finest.high_m[point] += static_cast<float>(static_cast<double>(around[point].high) * kMetresPerDeviation);
  }
  return finest;
}

}  // namespace

StoredDeltas DeltasFromChildren(Quadcode node, const ElevationPage& page, const std::array<BoundedPage, 4>& children) {
  BELVEDERE_CHECK(node.level() < kMaxLevel);
  const int32_t base_mm = page.at(kCells / 2, kCells / 2);  // near which floats are finest
  std::vector<float> heights_m;
  heights_m.reserve(kVerticesPerPage);
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) heights_m.push_back(OverBase(page.at(column, row), base_mm));
  }
  return StoreDeltas(DeltaValuesOf(node, heights_m, FinestUnder(node, children, base_mm)));
}

}  // namespace belvedere

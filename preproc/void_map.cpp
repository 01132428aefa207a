#include "preproc/void_map.h"

#include <algorithm>

namespace belvedere {

bool VoidMap::Holds(int column, int row) const {
  if (runs_.empty() || row < 0 || static_cast<size_t>(row) + 1 >= row_starts_.size()) return false;
  const auto first = runs_.begin() + static_cast<std::ptrdiff_t>(row_starts_[static_cast<size_t>(row)]);
  const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(row_starts_[static_cast<size_t>(row) + 1]);
  const auto after =
      std::upper_bound(first, end, column, [](int wanted, const Run& run) { return wanted < run.first; });
  return after != first && column < std::prev(after)->end;
}

size_t VoidFinder::RootOf(size_t run) {
  while (parents_[run] != run) run = parents_[run] = parents_[parents_[run]];
  return run;
}

void VoidFinder::Join(size_t a, size_t b) {
  const size_t root = RootOf(a), other = RootOf(b);
  if (root == other) return;
  parents_[other] = root;
  outside_[root] |= outside_[other];
}

void VoidFinder::AddRow(std::span<const uint8_t> missing) {
  const size_t first = runs_.size();
  row_starts_.push_back(first);
  for (int column = 0; column < width_;) {
    if (missing[static_cast<size_t>(column)] == 0) {
      ++column;
      continue;
    }
    VoidMap::Run run{column, column};
    while (run.end < width_ && missing[static_cast<size_t>(run.end)] != 0) ++run.end;
    column = run.end;
    const bool at_edge = row_starts_.size() == 1 || (!wraps_ && (run.first == 0 || run.end == width_));
    parents_.push_back(runs_.size());
    outside_.push_back(at_edge ? 1 : 0);
    runs_.push_back(run);
  }
  if (wraps_ && runs_.size() > first && runs_[first].first == 0 && runs_.back().end == width_)
    Join(first, runs_.size() - 1);
  JoinWithRowBefore(first);
}

void VoidFinder::JoinWithRowBefore(size_t first_of_row) {
  if (row_starts_.size() < 2) return;
  size_t above = row_starts_[row_starts_.size() - 2];
  for (size_t run = first_of_row; run < runs_.size(); ++run) {
    while (above < first_of_row && runs_[above].end <= runs_[run].first) ++above;
    for (size_t other = above; other < first_of_row && runs_[other].first < runs_[run].end; ++other) Join(run, other);
  }
}

VoidMap VoidFinder::Finish() {
  VoidMap map;
  if (row_starts_.empty()) return map;
  for (size_t run = row_starts_.back(); run < runs_.size(); ++run) outside_[RootOf(run)] = 1;
  row_starts_.push_back(runs_.size());
  for (size_t row = 0; row + 1 < row_starts_.size(); ++row) {
    map.row_starts_.push_back(map.runs_.size());
    for (size_t run = row_starts_[row]; run < row_starts_[row + 1]; ++run) {
      if (outside_[RootOf(run)] == 0) map.runs_.push_back(runs_[run]);
    }
  }
  map.row_starts_.push_back(map.runs_.size());
  if (map.runs_.empty()) return {};
  return map;
}

}  // namespace belvedere

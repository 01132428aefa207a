// VoidMap: which of a source's missing pixels are voids, those that its valid pixels enclose.
//
// A void is an area of missing pixels, joined along their sides, that reaches no edge of the raster; what does reach
// one lies outside of the source. Found in one pass over the rows: runs of missing pixels that touch are joined
// (Rosenfeld and Pfaltz 1966, "Sequential operations in digital picture processing"), so that memory grows with the
// number of runs and not with that of pixels.
//
// Threads: values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

class VoidMap {
 public:
  bool empty() const { return runs_.empty(); }
  bool Holds(int column, int row) const;

 private:
  friend class VoidFinder;
  struct Run {
    int32_t first = 0, end = 0;
  };
  std::vector<size_t> row_starts_;  // in runs_, one more than there are rows
  std::vector<Run> runs_;
};

class VoidFinder {
 public:
  // wraps: the last column lies beside the first.
  VoidFinder(int width, bool wraps) : width_(width), wraps_(wraps) {}
  // Not 0 where a pixel is missing; as many as the raster is wide. Rows come from the first to the last.
  void AddRow(std::span<const uint8_t> missing);
  VoidMap Finish();

 private:
  size_t RootOf(size_t run);
  void Join(size_t a, size_t b);
  void JoinWithRowBefore(size_t first_of_row);

  const int width_;
  const bool wraps_;
  std::vector<size_t> row_starts_;
  std::vector<VoidMap::Run> runs_;
  std::vector<size_t> parents_;   // of runs; a root is its own
  std::vector<uint8_t> outside_;  // of roots: the area reaches an edge
};

}  // namespace belvedere

// LayerPixels: windows of a layer's posts or texels at one level, put together from its pages.
//
// Where the layer has a page of the level a value is the one stored, also on the page's borders; near the poles, where
// pages are wide (quadcode.h), between those stored. Elsewhere the finest page above it is enlarged, bilinear, as the
// run-time system draws it, or there is nothing: see Enlarge.
//
// Columns are counted from 180 W, taken round the Earth; rows from 90 S. Windows run row by row from the south-west.
// Units: metres above the ellipsoid; sRGB and straight alpha.
// Threads: one at a time.
// Owns: the last pages read, kKeptPages at most.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace belvedere {

// What stands where the layer has no page of the level: coarser pages, enlarged, or NaN and transparent black.
enum class Enlarge { kCoarser, kNothing };

struct PixelRange {
  int64_t first_column = 0, first_row = 0;
  int width = 0, height = 0;
};

class LayerPixels {
 public:
  LayerPixels(const Dataset& dataset, int layer, int level, Enlarge enlarge);

  // out: width * height. REQUIRES: the layer is of that kind, and the rows are on the Earth.
  Status ReadHeights(const PixelRange& range, std::span<float> out_m);
  Status ReadColours(const PixelRange& range, std::span<uint8_t> out_rgba);

  int64_t pages_read() const { return pages_read_; }

 private:
  static constexpr size_t kKeptPages = 64;

  // A square of the level, as large as its quadnodes are but near the poles, and the finest page there is of it: that
  // of the quadnode that holds it, or an ancestor's.
  struct Piece {
    int64_t column = 0, row = 0;  // of the quadnode's first cell, in the range's numbering
    Quadcode page;
    int doublings_east = 0, doublings_north = 0;  // the page is enlarged by 2^doublings either way
    int64_t nodes_west = 0, nodes_south = 0;      // of the quadnode, within the page
    bool owner = false;                           // of any post of the range; else it only borders on it
  };
  Piece PieceAt(int64_t node_column, int64_t node_row, int cells) const;
  std::vector<Piece> PiecesFor(const PixelRange& range) const;
  Result<std::shared_ptr<const Page>> PageOf(Quadcode node);

  const Dataset& dataset_;
  const int layer_, level_;
  const Enlarge enlarge_;
  const LayerKind kind_;
  int64_t pages_read_ = 0;
  std::list<std::pair<Quadcode, std::shared_ptr<const Page>>> kept_;  // most recently used first
};

}  // namespace belvedere

#include "preproc/layer_pixels.h"

#include "runtime/paging/page.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

// REQUIRES: b > 0
int64_t FloorDivide(int64_t a, int64_t b) {
  return a >= 0 ? a / b : -1 - (-1 - a) / b;
}

// A place between the posts or texels of a page: the one before it, and how far it lies on the way to the next.
struct Between {
  int before = 0;
  double share = 0;
};

// Post number `cell` of a quadnode, counted in the page, along whose side there are 2^doublings quadnodes: `nodes`
// before this one.
Between PostIn(int64_t cell, int64_t nodes, int doublings) {
  const int64_t fine = nodes * kCells + cell;
  const int64_t before = fine >> doublings;
  return {static_cast<int>(before), std::ldexp(static_cast<double>(fine - (before << doublings)), -doublings)};
}

// The same of a texel, whose place is its centre.
Between TexelIn(int64_t cell, int64_t nodes, int doublings) {
  const double place = std::ldexp(static_cast<double>(nodes * kImageInner + cell) + 0.5, -doublings) - 0.5;
  const double before = std::floor(place);
  return {static_cast<int>(before), place - before};
}

double HeightAt(const ElevationPage& page, const Between& x, const Between& y) {
  if (x.share == 0 && y.share == 0) return page.at(x.before, y.before) / 1000.0;
  const auto row = [&](int number) {
    return page.at(x.before, number) * (1 - x.share) + page.at(x.before + 1, number) * x.share;
  };
  return (row(y.before) * (1 - y.share) + row(y.before + 1) * y.share) / 1000.0;
}

const uint8_t* TexelAt(const ImagePage& page, int column, int row) {
  return &page.texels[4 * static_cast<size_t>((row + kImageGutter) * kImageSide + column + kImageGutter)];
}

// Colours count as much as they cover, so that what is transparent darkens nothing.
void WriteColour(const ImagePage& page, const Between& x, const Between& y, uint8_t* out) {
  std::array<double, 4> sum{};
  for (const auto& [dx, dy] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
    const double weight = (dx == 0 ? 1 - x.share : x.share) * (dy == 0 ? 1 - y.share : y.share);
    const uint8_t* texel = TexelAt(page, x.before + dx, y.before + dy);
    sum[3] += weight * texel[3];
    for (size_t c = 0; c < 3; ++c) sum[c] += weight * texel[3] * texel[c];
  }
  out[3] = static_cast<uint8_t>(std::lrint(sum[3]));
  for (size_t c = 0; c < 3; ++c) out[c] = out[3] == 0 ? uint8_t{0} : static_cast<uint8_t>(std::lrint(sum[c] / sum[3]));
}

// The part of the range that lies in [first, first + count), as numbers within the range.
std::pair<int, int> Within(int64_t range_first, int range_count, int64_t first, int64_t count) {
  return {static_cast<int>(std::max<int64_t>(first - range_first, 0)),
          static_cast<int>(std::min<int64_t>(first + count - range_first, range_count))};
}

}  // namespace

LayerPixels::LayerPixels(const Dataset& dataset, int layer, int level, Enlarge enlarge)
    : dataset_(dataset),
      layer_(layer),
      level_(level),
      enlarge_(enlarge),
      kind_(dataset.layers()[static_cast<size_t>(layer)].kind) {}

LayerPixels::Piece LayerPixels::PieceAt(int64_t node_column, int64_t node_row, int cells) const {
  const int64_t around = int64_t{kTreeColumns} << level_;
  const int64_t column = ((node_column % around) + around) % around;
  const int wide = std::countr_zero(static_cast<uint64_t>(around / Quadcode::ColumnsAround(level_, node_row)));
  Quadcode page = Quadcode::FromColumnRow(level_, column >> wide, node_row);
  while (!page.is_root() && !dataset_.Exists(layer_, page)) page = page.Parent();
  const int north = level_ - page.level(), east = north + page.Doublings();
  return {.column = node_column * cells,
          .row = node_row * cells,
          .page = page,
          .doublings_east = east,
          .doublings_north = north,
          .nodes_west = column - (page.column() << east),
          .nodes_south = node_row - (page.row() << north)};
}

// Those of coarse pages first. Posts on a border belong to the quadnodes on both sides; a quadnode that only borders on
// the range counts where it is finer than one inside.
std::vector<LayerPixels::Piece> LayerPixels::PiecesFor(const PixelRange& range) const {
  const bool posts = kind_ == LayerKind::kElevation;
  const int cells = posts ? kCells : kImageInner;
  const int64_t border = posts ? 1 : 0;
  const int64_t rows = int64_t{kTreeRows} << level_;
  const int64_t last_column = FloorDivide(range.first_column + range.width - 1, cells);
  const int64_t last_row = std::min(FloorDivide(range.first_row + range.height - 1, cells), rows - 1);
  std::vector<Piece> pieces;
  int most_doublings = 0;
  for (int64_t row = std::max<int64_t>(FloorDivide(range.first_row - border, cells), 0); row <= last_row; ++row) {
    for (int64_t column = FloorDivide(range.first_column - border, cells); column <= last_column; ++column) {
      Piece piece = PieceAt(column, row, cells);
      const int64_t own_rows = cells + (row == rows - 1 ? border : 0);  // the pole's posts have no other owner
      piece.owner = piece.column + cells > range.first_column && piece.row + own_rows > range.first_row;
      if (piece.owner) most_doublings = std::max(most_doublings, piece.doublings_north);
      pieces.push_back(piece);
    }
  }
  std::erase_if(pieces, [&](const Piece& piece) {
    return (enlarge_ == Enlarge::kNothing && piece.doublings_north > 0) ||
           (!piece.owner && piece.doublings_north >= most_doublings);
  });
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.doublings_north > b.doublings_north; });
  return pieces;
}

Result<std::shared_ptr<const Page>> LayerPixels::PageOf(Quadcode node) {
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept.first == node; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().second;
  }
  std::shared_ptr<const Page> page;
  if (kind_ == LayerKind::kElevation) {
    auto read = dataset_.ReadElevation(layer_, node);
    if (!read.ok()) return read.status();
    page = std::move(*read);
  } else {
    auto read = dataset_.ReadImage(layer_, node);
    if (!read.ok()) return read.status();
    page = std::move(*read);
  }
  ++pages_read_;
  if (kept_.size() >= kKeptPages) kept_.pop_back();
  kept_.emplace_front(node, page);
  return page;
}

Status LayerPixels::ReadHeights(const PixelRange& range, std::span<float> out_m) {
  std::fill(out_m.begin(), out_m.end(), std::numeric_limits<float>::quiet_NaN());
  for (const Piece& piece : PiecesFor(range)) {
    const auto read = PageOf(piece.page);
    if (!read.ok()) return read.status();
    const auto& page = static_cast<const ElevationPage&>(**read);
    const auto [left, right] = Within(range.first_column, range.width, piece.column, kPosts);
    const auto [bottom, top] = Within(range.first_row, range.height, piece.row, kPosts);
    for (int row = bottom; row < top; ++row) {
      const Between y = PostIn(range.first_row + row - piece.row, piece.nodes_south, piece.doublings_north);
      float* const out = &out_m[static_cast<size_t>(row) * static_cast<size_t>(range.width)];
      for (int column = left; column < right; ++column) {
        const Between x = PostIn(range.first_column + column - piece.column, piece.nodes_west, piece.doublings_east);
        out[column] = static_cast<float>(HeightAt(page, x, y));
      }
    }
  }
  return {};
}

Status LayerPixels::ReadColours(const PixelRange& range, std::span<uint8_t> out_rgba) {
  std::fill(out_rgba.begin(), out_rgba.end(), uint8_t{0});
  for (const Piece& piece : PiecesFor(range)) {
    const auto read = PageOf(piece.page);
    if (!read.ok()) return read.status();
    const auto& page = static_cast<const ImagePage&>(**read);
    const auto [left, right] = Within(range.first_column, range.width, piece.column, kImageInner);
    const auto [bottom, top] = Within(range.first_row, range.height, piece.row, kImageInner);
    for (int row = bottom; row < top; ++row) {
      const int64_t cell_y = range.first_row + row - piece.row;
      const Between y = TexelIn(cell_y, piece.nodes_south, piece.doublings_north);
      uint8_t* const out = &out_rgba[4 * static_cast<size_t>(row) * static_cast<size_t>(range.width)];
      for (int column = left; column < right; ++column) {
        const int64_t cell_x = range.first_column + column - piece.column;
        uint8_t* const texel = out + 4 * static_cast<size_t>(column);
        if (piece.doublings_east == 0) {
          std::copy_n(TexelAt(page, static_cast<int>(cell_x), static_cast<int>(cell_y)), 4, texel);
        } else {
          WriteColour(page, TexelIn(cell_x, piece.nodes_west, piece.doublings_east), y, texel);
        }
      }
    }
  }
  return {};
}

}  // namespace belvedere

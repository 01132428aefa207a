#include "managers/label_layout.h"

#include <cmath>
#include <numeric>

namespace belvedere {
namespace {

constexpr float kCellWidth_px = 16, kCellHeight_px = 8;
constexpr std::ptrdiff_t kMostTried = 1500;  // new labels a list: the nearest
constexpr float kMargin_px = 8;              // that a new label needs around it

int CellOf(float x, float size, int cells) {
  return std::clamp(static_cast<int>(std::floor(x / size)), 0, cells - 1);
}

}  // namespace

std::span<const LabelPlace> LabelLayout::Lay(std::span<const LabelWish> wishes, int width_px, int height_px) {
  columns_ = static_cast<int>(std::ceil(static_cast<float>(width_px) / kCellWidth_px));
  rows_ = static_cast<int>(std::ceil(static_cast<float>(height_px) / kCellHeight_px));
  words_ = (static_cast<size_t>(columns_) + 63) / 64;
  taken_.assign(words_ * static_cast<size_t>(rows_), 0);
  places_.clear();
  Order(wishes);
  for (const size_t index : order_) {
    if (places_.size() == kMostLabels) break;
    const LabelWish& wish = wishes[index];
    if (wish.size.lines == 0) continue;
    const float margin_px = wish.shown_before ? 0 : kMargin_px;
    const auto place_at = [&](LabelSide side) {
      if (!TryPlace(wish, side, margin_px)) return false;
      places_.push_back({index, side});
      return true;
    };
    if (wish.shown_before && place_at(wish.side_before)) continue;
    for (int side = 0; side < kLabelSides; ++side) {
      if (place_at(static_cast<LabelSide>(side))) break;
    }
  }
  return places_;
}

// Those that were shown, then the nearest of the others.
void LabelLayout::Order(std::span<const LabelWish> wishes) {
  order_.resize(wishes.size());
  std::iota(order_.begin(), order_.end(), size_t{0});
  const auto nearer = [&](size_t a, size_t b) {
    return wishes[a].distance_m != wishes[b].distance_m ? wishes[a].distance_m < wishes[b].distance_m : a < b;
  };
  const auto others = std::partition(order_.begin(), order_.end(), [&](size_t i) { return wishes[i].shown_before; });
  std::sort(order_.begin(), others, nearer);
  if (static_cast<size_t>(order_.end() - others) > kMostTried) {
    std::nth_element(others, others + kMostTried, order_.end(), nearer);
    order_.erase(others + kMostTried, order_.end());
  }
  std::sort(others, order_.end(), nearer);
}

bool LabelLayout::TryPlace(const LabelWish& wish, LabelSide side, float margin_px) {
  LabelBox box = BoxOf(side, wish.beside_px, wish.size);
  box.left += wish.anchor_px.x;
  box.right += wish.anchor_px.x;
  box.top += wish.anchor_px.y;
  box.bottom += wish.anchor_px.y;
  return Reserve(box, margin_px);
}

// False where a cell of it is taken or it lies beside the picture.
bool LabelLayout::Reserve(const LabelBox& box, float margin_px) {
  const float width = kCellWidth_px * static_cast<float>(columns_), height = kCellHeight_px * static_cast<float>(rows_);
  if (box.right < 0 || box.left > width || box.bottom < 0 || box.top > height) return false;
  const auto each_word = [&](float margin, auto&& visit) {
    const int first_column = CellOf(box.left - margin, kCellWidth_px, columns_);
    const int last_column = CellOf(box.right + margin, kCellWidth_px, columns_);
    const int last_row = CellOf(box.bottom + margin, kCellHeight_px, rows_);
    for (int row = CellOf(box.top - margin, kCellHeight_px, rows_); row <= last_row; ++row) {
      for (int word = first_column / 64; word <= last_column / 64; ++word) {
        const int from = std::max(first_column - 64 * word, 0), to = std::min(last_column - 64 * word, 63);
        const uint64_t bits = (~uint64_t{0} << from) & (~uint64_t{0} >> (63 - to));
        if (!visit(taken_[static_cast<size_t>(row) * words_ + static_cast<size_t>(word)], bits)) return false;
      }
    }
    return true;
  };
  if (!each_word(margin_px, [](uint64_t word, uint64_t bits) { return (word & bits) == 0; })) return false;
  return each_word(0, [](uint64_t& word, uint64_t bits) {
    word |= bits;
    return true;
  });
}

}  // namespace belvedere

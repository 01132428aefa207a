// Label layout: which objects of a view get a label, and on which side of them it stands, so that no two overlap.
//
// One pass over the wishes: those whose label was shown before first, each on the side that it had if that is free,
// then the others, nearest first. A label that was not there before needs a margin of free room around it, so that
// labels do not come and go where there is just not enough. Room is kept as a grid of cells, so the cost does not grow
// with the number of labels that are there.
//
// Units:   pixels from the upper left corner, y downwards.
// Threads: pure; scratch belongs to its user.
#pragma once

#include "runtime/scene/label_box.h"

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

inline constexpr size_t kMostLabels = 300;  // a view; more could not be read

struct LabelWish {
  glm::vec2 anchor_px{};                      // the object
  float beside_px = 0;                        // its radius
  float distance_m = 0;                       // nearer ones come first
  LabelSize size;                             // of its text
  bool shown_before = false;                  // in the list before,
  LabelSide side_before = LabelSide::kRight;  // there
};

struct LabelPlace {
  size_t wish = 0;
  LabelSide side = LabelSide::kRight;
};

class LabelLayout {
 public:
  // At most kMostLabels. Valid until the next call.
  std::span<const LabelPlace> Lay(std::span<const LabelWish> wishes, int width_px, int height_px);

 private:
  void Order(std::span<const LabelWish> wishes);
  bool TryPlace(const LabelWish& wish, LabelSide side, float margin_px);
  bool Reserve(const LabelBox& box, float margin_px);

  int columns_ = 0, rows_ = 0;
  size_t words_ = 0;             // of a row
  std::vector<uint64_t> taken_;  // a bit a cell, row by row
  std::vector<size_t> order_;
  std::vector<LabelPlace> places_;
};

}  // namespace belvedere

// LabelBox: where the data block of an object stands on the screen, as whoever finds room for it and whoever draws it
// agree.
//
// Units:   pixels, y downwards; offsets from the object's place.
// Threads: pure functions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace belvedere {

enum class LabelSide : uint8_t { kRight, kUpperRight, kLowerRight, kUpperLeft, kLowerLeft };
inline constexpr int kLabelSides = 5;

inline constexpr float kLabelLine_px = 15;         // from line to line
inline constexpr float kLabelCharacter_px = 7.6F;  // of the widest usual letters of the font
inline constexpr float kLabelLead_px = 22;         // how far a block that stands off lies from its object

struct LabelSize {
  int characters = 0;  // of the longest line
  int lines = 0;
};
inline LabelSize SizeOf(std::string_view text) {
  LabelSize size;
  for (size_t begin = 0; begin <= text.size() && !text.empty();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    size.characters = std::max(size.characters, static_cast<int>(end - begin));
    ++size.lines;
    begin = end + 1;
  }
  return size;
}

struct LabelBox {
  float left = 0, top = 0, right = 0, bottom = 0;
  bool has_leader = false;  // a line joins it to the object
};
// How far from an object's place its label begins: beside the model that it is drawn as, or beside its symbol.
inline float BesideLabel(bool as_model, double radius_px) {
  constexpr double kSymbol_px = 13;
  return static_cast<float>(as_model ? std::clamp(radius_px, 3.0, 60.0) : kSymbol_px);
}

// beside_px: as BesideLabel says.
inline LabelBox BoxOf(LabelSide side, float beside_px, LabelSize size) {
  const float width = kLabelCharacter_px * static_cast<float>(size.characters);
  const float height = kLabelLine_px * static_cast<float>(size.lines);
  if (side == LabelSide::kRight) return {beside_px + 3, -0.5F * height, beside_px + 3 + width, 0.5F * height, false};
  const float off = beside_px + kLabelLead_px;
  const bool left = side == LabelSide::kUpperLeft || side == LabelSide::kLowerLeft;
  const bool upper = side == LabelSide::kUpperRight || side == LabelSide::kUpperLeft;
  LabelBox box;
  box.left = left ? -off - width : off;
  box.right = box.left + width;
  box.top = upper ? -off - height : off;
  box.bottom = box.top + height;
  box.has_leader = true;
  return box;
}

}  // namespace belvedere

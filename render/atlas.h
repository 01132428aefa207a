// Atlas: the picture of all glyphs and symbols that lie over a view, made at start with FreeType.
//
// Two bytes a texel: how much the shape covers it, and how much the shape with a dark outline does. The outline makes
// text legible on any ground.
//
// Units:   pixels; glyph boxes relative to the pen on the baseline, y downwards.
// Threads: immutable once made.
#pragma once

#include "runtime/base/status.h"
#include "runtime/scene/display_list.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

// Where a shape lies in the atlas, and where its quad goes relative to the pen.
struct AtlasShape {
  float left = 0, top = 0, width = 0, height = 0;  // pixels
  float u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  float advance = 0;  // to the next glyph
};

class Atlas {
 public:
  static constexpr int kWidth = 512;
  static constexpr int kHeight = 256;
  static constexpr int kFontHeight_px = 13;
  static constexpr float kLineHeight_px = 17;
  static constexpr float kSymbolSide_px = 26;

  // Symbols and Latin-1 text in that font. Without the font there are symbols only, and font() says why.
  explicit Atlas(const std::string& font_path);

  const AtlasShape& Glyph(unsigned char latin1) const { return glyphs_[latin1]; }
  const AtlasShape& Symbol(SymbolShape shape) const { return symbols_[static_cast<size_t>(shape)]; }
  // A shape that covers all of its quad.
  const AtlasShape& solid() const { return solid_; }
  float WidthOf(std::string_view latin1) const;
  const std::vector<uint8_t>& texels() const { return texels_; }  // kWidth * kHeight * 2
  const Status& font() const { return font_; }

 private:
  // Adds a coverage picture (0..255) and its outline; returns where it is.
  AtlasShape Add(const std::vector<uint8_t>& cover, int width, int height);
  Status AddFont(const std::string& path);
  void AddSymbols();

  std::vector<uint8_t> texels_;
  std::array<AtlasShape, 256> glyphs_{};
  std::array<AtlasShape, kSymbolShapes> symbols_{};
  AtlasShape solid_;
  Status font_;
  int next_x_ = 0, next_y_ = 0, row_height_ = 0;
};

// UTF-8 to Latin-1; what Latin-1 has not becomes '?'.
std::string ToLatin1(std::string_view utf8);

}  // namespace belvedere

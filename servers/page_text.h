// Page text: writes small text into colour pages, upright where north is up.
//
// All glyphs are drawn once, by FreeType, when it is made. Text is Latin-1, one line, with a halo of a texel and a half
// around it, so that it is legible on any ground.
//
// Units: texels; column east from the page's west edge, row north from its south edge, gutter included.
// Threads: immutable once made; any thread writes into pages of its own.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/page.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

inline constexpr const char* kPageFontPath = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

using TexelColour = std::array<uint8_t, 3>;

// Columns and rows first .. last - 1.
struct TexelBox {
  int west = 0, south = 0, east = 0, north = 0;
  bool Meets(const TexelBox& other) const {
    return west < other.east && other.west < east && south < other.north && other.south < north;
  }
};
inline constexpr TexelBox kInnerTexels = {kImageGutter, kImageGutter, kImageGutter + kImageInner,
                                          kImageGutter + kImageInner};

// Lays a colour over a texel of mip level 0, by the rules of straight alpha. cover: 0 .. 1.
void CoverTexel(ImagePage& page, int column, int row, const TexelColour& colour, float cover);
// Gives every texel that colour and no alpha: filtered lines of that colour have no dark edges.
std::unique_ptr<ImagePage> MakeTransparentPage(const TexelColour& colour);

class PageText {
 public:
  // Without the font nothing is written, and font() says why.
  explicit PageText(const std::string& font_path = kPageFontPath);
  const Status& font() const { return font_; }

  // What the text covers with its halo, when its middle is at (column, row); empty without the font.
  TexelBox BoxAround(std::string_view latin1, int column, int row) const;
  // REQUIRES: the box of that text, as BoxAround gives it, lies within the page.
  void Write(ImagePage& page, const TexelBox& box, std::string_view latin1, const TexelColour& ink,
             const TexelColour& halo) const;

 private:
  struct Glyph {
    int width = 0, height = 0, left = 0, top = 0, advance = 0;  // top: above the base line
    std::vector<uint8_t> cover;                                 // row by row from the top
  };
  Status Load(const std::string& path);
  int WidthOf(std::string_view latin1) const;

  std::array<Glyph, 256> glyphs_;
  Status font_;
};

}  // namespace belvedere

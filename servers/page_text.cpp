#include "servers/page_text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr int kFontHeight_px = 13;
constexpr int kDigitHeight_px = 10;  // of that font's figures and capitals, which is all that is written
constexpr int kHalo_px = 2;

// Calls draw(column, row, cover) for each texel of the text's glyphs; row counts down from the top of the figures.
template <class Glyphs, class Draw>
void ForEachTexel(const Glyphs& glyphs, std::string_view latin1, const Draw& draw) {
  int pen = 0;
  for (const char c : latin1) {
    const auto& glyph = glyphs[static_cast<unsigned char>(c)];
    for (int row = 0; row < glyph.height; ++row) {
      for (int column = 0; column < glyph.width; ++column) {
        draw(pen + glyph.left + column, kDigitHeight_px - glyph.top + row,
             static_cast<float>(glyph.cover[static_cast<size_t>(row * glyph.width + column)]) / 255);
      }
    }
    pen += glyph.advance;
  }
}

}  // namespace

void CoverTexel(ImagePage& page, int column, int row, const TexelColour& colour, float cover) {
  if (cover <= 0) return;
  uint8_t* texel = &page.texels[4 * static_cast<size_t>(row * kImageSide + column)];
  const float under = static_cast<float>(texel[3]) / 255 * (1 - cover);
  const float alpha = cover + under;
  for (size_t i = 0; i < colour.size(); ++i) {
    const float value = (cover * static_cast<float>(colour[i]) + under * static_cast<float>(texel[i])) / alpha;
    texel[i] = static_cast<uint8_t>(value + 0.5F);
  }
  texel[3] = static_cast<uint8_t>(255 * alpha + 0.5F);
}

std::unique_ptr<ImagePage> MakeTransparentPage(const TexelColour& colour) {
  auto page = std::make_unique<ImagePage>();
  page->texels.resize(ImagePage::MipOffset(kImageMipLevels, page->format));
  const std::array<uint8_t, 4> clear = {colour[0], colour[1], colour[2], 0};
  for (size_t i = 0; i < page->texels.size(); i += clear.size()) std::ranges::copy(clear, &page->texels[i]);
  return page;
}

PageText::PageText(const std::string& font_path) : font_(Load(font_path)) {}

Status PageText::Load(const std::string& path) {
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) return Status::Error("FreeType cannot be started; image layers have no text");
  FT_Face face = nullptr;
  if (FT_New_Face(library, path.c_str(), 0, &face) != 0 || FT_Set_Pixel_Sizes(face, 0, kFontHeight_px) != 0) {
    if (face != nullptr) FT_Done_Face(face);
    FT_Done_FreeType(library);
    return Status::Error("{}: cannot read the font, image layers have no text; install fonts-dejavu-core", path);
  }
  for (unsigned code = 32; code < glyphs_.size(); ++code) {
    if ((code >= 127 && code < 160) || FT_Load_Char(face, code, FT_LOAD_RENDER) != 0) continue;
    const FT_GlyphSlot slot = face->glyph;
    Glyph& glyph = glyphs_[code];
    glyph.width = static_cast<int>(slot->bitmap.width);
    glyph.height = static_cast<int>(slot->bitmap.rows);
    glyph.left = slot->bitmap_left;
    glyph.top = slot->bitmap_top;
    glyph.advance = static_cast<int>((slot->advance.x + 32) / 64);
    for (int row = 0; row < glyph.height; ++row) {
      const uint8_t* line = slot->bitmap.buffer + row * slot->bitmap.pitch;
      glyph.cover.insert(glyph.cover.end(), line, line + glyph.width);
    }
  }
  FT_Done_Face(face);
  FT_Done_FreeType(library);
  return {};
}

int PageText::WidthOf(std::string_view latin1) const {
  int width = 0;
  for (const char c : latin1) width += glyphs_[static_cast<unsigned char>(c)].advance;
  return width;
}

TexelBox PageText::BoxAround(std::string_view latin1, int column, int row) const {
  if (!font_.ok() || latin1.empty()) return {column, row, column, row};
  const int width = WidthOf(latin1) + 2 * kHalo_px;
  const int height = kDigitHeight_px + 2 * kHalo_px;
  const int west = column - width / 2;
  const int south = row - height / 2;
  return {west, south, west + width, south + height};
}

void PageText::Write(ImagePage& page, const TexelBox& box, std::string_view latin1, const TexelColour& ink,
                     const TexelColour& halo) const {
  if (!font_.ok() || latin1.empty()) return;
  BELVEDERE_CHECK(box.west >= 0 && box.south >= 0 && box.east <= kImageSide && box.north <= kImageSide);
  const int width = box.east - box.west;
  const int height = box.north - box.south;
  std::vector<float> text(static_cast<size_t>(width) * static_cast<size_t>(height));
  std::vector<float> grown(text.size());
  ForEachTexel(glyphs_, latin1, [&](int column, int row, float cover) {
    for (int dy = -kHalo_px; dy <= kHalo_px; ++dy) {
      for (int dx = -kHalo_px; dx <= kHalo_px; ++dx) {
        const int x = column + dx + kHalo_px;
        const int y = row + dy + kHalo_px;
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        const size_t at = static_cast<size_t>(y * width + x);
        const float fade = std::clamp(2.3F - std::sqrt(static_cast<float>(dx * dx + dy * dy)), 0.0F, 1.0F);
        grown[at] = std::max(grown[at], fade * cover);
        if (dx == 0 && dy == 0) text[at] = std::max(text[at], cover);
      }
    }
  });
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t at = static_cast<size_t>(y * width + x);
      CoverTexel(page, box.west + x, box.north - 1 - y, halo, grown[at]);
      CoverTexel(page, box.west + x, box.north - 1 - y, ink, text[at]);
    }
  }
}

}  // namespace belvedere

#include "render/atlas.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace belvedere {
namespace {

const std::string kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

// Sums of the two channels over a shape.
struct Cover {
  int filled = 0, outlined = 0;
};
Cover CoverOf(const Atlas& atlas, const AtlasShape& shape) {
  Cover cover;
  const int left = static_cast<int>(std::lround(shape.u0 * Atlas::kWidth));
  const int top = static_cast<int>(std::lround(shape.v0 * Atlas::kHeight));
  for (int y = top; y < top + static_cast<int>(shape.height); ++y) {
    for (int x = left; x < left + static_cast<int>(shape.width); ++x) {
      const size_t texel = 2 * static_cast<size_t>(y * Atlas::kWidth + x);
      cover.filled += atlas.texels()[texel];
      cover.outlined += atlas.texels()[texel + 1];
      EXPECT_LE(atlas.texels()[texel], atlas.texels()[texel + 1]);
    }
  }
  return cover;
}

TEST(Atlas, EverySymbolAndLetterHasAShapeAndAnOutline) {
  const Atlas atlas(kFont);
  ASSERT_TRUE(atlas.font().ok()) << atlas.font().message();
  for (const SymbolShape symbol : {SymbolShape::kAir, SymbolShape::kGround, SymbolShape::kSurface,
                                   SymbolShape::kSubsurface, SymbolShape::kOther}) {
    const Cover cover = CoverOf(atlas, atlas.Symbol(symbol));
    EXPECT_GT(cover.filled, 40 * 255);
    EXPECT_GT(cover.outlined, cover.filled);
  }
  for (const char character : {'A', 'z', '0', '.', '\xB0'}) {
    const auto letter = static_cast<unsigned char>(character);
    const Cover cover = CoverOf(atlas, atlas.Glyph(letter));
    EXPECT_GT(cover.filled, 0) << letter;
    EXPECT_GT(cover.outlined, cover.filled) << letter;
    EXPECT_GT(atlas.Glyph(letter).advance, 2) << letter;
  }
  EXPECT_NEAR(atlas.WidthOf("AA"), 2 * atlas.WidthOf("A"), 1e-3);
}

TEST(Atlas, WithoutTheFontThereAreStillSymbols) {
  const Atlas atlas("/no/such/font.ttf");
  EXPECT_FALSE(atlas.font().ok());
  EXPECT_NE(atlas.font().message().find("/no/such/font.ttf"), std::string::npos);
  EXPECT_EQ(atlas.WidthOf("abc"), 0);
  EXPECT_GT(CoverOf(atlas, atlas.Symbol(SymbolShape::kAir)).filled, 0);
}

TEST(Atlas, TextBecomesLatin1) {
  EXPECT_EQ(ToLatin1("37° N"), "37\xB0 N");
  EXPECT_EQ(ToLatin1("é"), "\xE9");
  EXPECT_EQ(ToLatin1("日本"), "??");
  EXPECT_EQ(ToLatin1("cut \xC3"), "cut ?");
}

}  // namespace
}  // namespace belvedere

#include "servers/mip_levels.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

ImagePage EmptyPage(ImageFormat format) {
  ImagePage page;
  page.format = format;
  page.texels.resize(ImagePage::MipOffset(kImageMipLevels, format));
  return page;
}

TEST(MipLevels, AreMeansOfWhatTheyCover) {
  ImagePage page = EmptyPage(ImageFormat::kR8);
  for (size_t row = 0; row < 256; ++row) {
    for (size_t column = 0; column < 256; ++column) page.texels[row * 256 + column] = static_cast<uint8_t>(column);
  }
  FillMipLevels(page);
  const uint8_t* half = page.texels.data() + ImagePage::MipOffset(1, page.format);
  EXPECT_EQ(half[0], 1);              // 0 and 1, rounded up
  EXPECT_EQ(half[5 * 128 + 10], 21);  // 20 and 21
  const uint8_t* quarter = page.texels.data() + ImagePage::MipOffset(2, page.format);
  EXPECT_EQ(quarter[63 * 64 + 63], 254);
}

TEST(MipLevels, KeepAnEvenImageEven) {
  for (const ImageFormat format : {ImageFormat::kR8, ImageFormat::kRGBA8}) {
    ImagePage page = EmptyPage(format);
    const size_t level0 = ImagePage::MipOffset(1, format);
    std::fill(page.texels.begin(), page.texels.begin() + static_cast<std::ptrdiff_t>(level0), uint8_t{128});
    FillMipLevels(page);
    for (const uint8_t value : page.texels) ASSERT_EQ(value, 128);
  }
}

TEST(MipLevels, WhatIsTransparentLendsNoColour) {
  ImagePage page = EmptyPage(ImageFormat::kRGBA8);
  const std::array<uint8_t, 4> red{200, 10, 20, 255};
  std::copy(red.begin(), red.end(), page.texels.begin());  // one of four texels; the others are transparent black
  FillMipLevels(page);
  const uint8_t* half = page.texels.data() + ImagePage::MipOffset(1, page.format);
  EXPECT_EQ(half[0], 200);
  EXPECT_EQ(half[1], 10);
  EXPECT_EQ(half[2], 20);
  EXPECT_EQ(half[3], 64);
  EXPECT_EQ(half[7], 0);
}

// Halfway between a bright texel and a transparent one the filter must not find a dark colour.
TEST(MipLevels, TheRimOfAnOverlayHasItsColour) {
  ImagePage page = EmptyPage(ImageFormat::kRGBA8);
  for (size_t row = 0; row < 256; ++row) {
    for (size_t column = 0; column < 100; ++column) {
      uint8_t* texel = &page.texels[4 * (row * 256 + column)];
      std::fill(texel, texel + 3, uint8_t{230});
      texel[3] = 255;
    }
  }
  FillMipLevels(page);
  ColourRims(page);
  for (int level = 0; level < kImageMipLevels; ++level) {
    const size_t side = static_cast<size_t>(kImageSide >> level), rim = 100U >> static_cast<unsigned>(level);
    const uint8_t* row = &page.texels[ImagePage::MipOffset(level, page.format) + 4 * side * (side / 2)];
    EXPECT_EQ(row[4 * (rim - 1) + 3], 255);
    EXPECT_EQ(row[4 * rim], 230) << "level " << level;
    EXPECT_EQ(row[4 * rim + 3], 0) << "it stays transparent";
    EXPECT_EQ(row[4 * (rim + 1)], 0) << "and no further than it is filtered";
  }
}

}  // namespace
}  // namespace belvedere

// What tests of made image layers look at.
#pragma once

#include "runtime/paging/page.h"
#include "servers/page_text.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

namespace belvedere {

using Rgba = std::array<int, 4>;

inline Rgba RgbaAt(const ImagePage& page, int column, int row) {
  const uint8_t* texel = &page.texels[4 * static_cast<size_t>(row * kImageSide + column)];
  return {texel[0], texel[1], texel[2], texel[3]};
}
inline int AlphaAt(const ImagePage& page, int column, int row) {
  return RgbaAt(page, column, row)[3];
}

// A neighbour's inner texels are this page's gutter, all but its outermost texels. The three pages are of one level,
// and other lies beside the page to the east or, if north, to the north.
inline void ExpectNoSeam(const ImagePage& page, const ImagePage& other, bool north, int tolerance) {
  const int bytes = static_cast<int>(page.format);
  const auto at = [&](const ImagePage& image, int along, int across, int byte) {
    const int texel = north ? across * kImageSide + along : along * kImageSide + across;
    return static_cast<int>(image.texels[static_cast<size_t>(texel * bytes + byte)]);
  };
  for (int along = 1; along < kImageSide - 1; ++along) {
    for (int across = 1; across < 2 * kImageGutter - 1; ++across) {
      for (int byte = 0; byte < bytes; ++byte) {
        ASSERT_NEAR(at(page, along, kImageInner + across, byte), at(other, along, across, byte), tolerance)
            << "along " << along << ", across " << across << ", byte " << byte;
      }
    }
  }
}

inline const PageText& NoText() {
  static const PageText kNoText("/no/such/font.ttf");
  return kNoText;
}

}  // namespace belvedere

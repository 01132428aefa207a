#include "servers/property_tint.h"

#include "servers/mip_levels.h"
#include "servers/texel_heights.h"

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

// Where the texel's middle lies, in posts from the page's first.
double PostOf(int texel) {
  const double post = (texel - kImageGutter + 0.5) * kPostsPerTexel;
  return std::clamp(post, -static_cast<double>(kApron), static_cast<double>(kPosts - 1 + kApron));
}

uint8_t Between(const PropertyPage& page, int channel, double x, double y) {
  const int column = std::min(static_cast<int>(std::floor(x)), kPosts - 2 + kApron);
  const int row = std::min(static_cast<int>(std::floor(y)), kPosts - 2 + kApron);
  const double fx = x - column, fy = y - row;
  const auto along = [&](int line) {
    return page.at(channel, column, line) * (1 - fx) + page.at(channel, column + 1, line) * fx;
  };
  return static_cast<uint8_t>(std::lrint(along(row) * (1 - fy) + along(row + 1) * fy));
}

}  // namespace

std::unique_ptr<ImagePage> TintProperty(const PropertyPage& page, const PropertyRecord& meaning) {
  auto image = std::make_unique<ImagePage>();
  image->texels.resize(ImagePage::MipOffset(kImageMipLevels, image->format));
  uint8_t* out = image->texels.data();
  for (int row = 0; row < kImageSide; ++row) {
    for (int column = 0; column < kImageSide; ++column, out += 4) {
      const double x = PostOf(column), y = PostOf(row);
      if (!meaning.classes.empty()) {
        const uint8_t byte = page.at(0, static_cast<int>(std::lrint(x)), static_cast<int>(std::lrint(y)));
        if (byte < meaning.classes.size()) std::copy_n(meaning.classes[byte].colour.begin(), 4, out);
        continue;
      }
      for (int c = 0; c < 3; ++c) out[c] = Between(page, page.channels >= 3 ? c : 0, x, y);
      out[3] = 255;
    }
  }
  FillMipLevels(*image);
  ColourRims(*image);
  return image;
}

}  // namespace belvedere

#include "servers/mip_levels.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <array>

namespace belvedere {
namespace {

void HalveR8(const uint8_t* from, uint8_t* to, size_t to_side) {
  const size_t from_side = 2 * to_side;
  for (size_t row = 0; row < to_side; ++row) {
    const uint8_t* south = from + 2 * row * from_side;
    const uint8_t* north = south + from_side;
    for (size_t column = 0; column < to_side; ++column) {
      const int sum = south[2 * column] + south[2 * column + 1] + north[2 * column] + north[2 * column + 1];
      to[row * to_side + column] = static_cast<uint8_t>((sum + 2) / 4);
    }
  }
}

using Texel = std::array<uint8_t, 4>;

Texel Mean(const std::array<const uint8_t*, 4>& texels) {
  constexpr size_t kAlpha = 3;
  const int alpha = texels[0][kAlpha] + texels[1][kAlpha] + texels[2][kAlpha] + texels[3][kAlpha];
  Texel mean{};
  if (alpha == 0) return mean;
  for (size_t channel = 0; channel < kAlpha; ++channel) {
    int sum = 0;
    if (alpha == 4 * 255) {
      for (const uint8_t* texel : texels) sum += texel[channel];
      mean[channel] = static_cast<uint8_t>((sum + 2) / 4);
    } else {
      for (const uint8_t* texel : texels) sum += texel[channel] * texel[kAlpha];
      mean[channel] = static_cast<uint8_t>((sum + alpha / 2) / alpha);
    }
  }
  mean[kAlpha] = static_cast<uint8_t>((alpha + 2) / 4);
  return mean;
}

void HalveRgba8(const uint8_t* from, uint8_t* to, size_t to_side) {
  const size_t from_pitch = 2 * to_side * sizeof(Texel);
  for (size_t row = 0; row < to_side; ++row) {
    const uint8_t* south = from + 2 * row * from_pitch;
    const uint8_t* north = south + from_pitch;
    for (size_t column = 0; column < to_side; ++column) {
      const size_t at = 2 * column * sizeof(Texel);
      const Texel mean = Mean({south + at, south + at + sizeof(Texel), north + at, north + at + sizeof(Texel)});
      for (const uint8_t value : mean) *to++ = value;
    }
  }
}

// The mean colour of the eight texels around one, of those that have any; transparent still.
Texel MeanAround(const uint8_t* texels, size_t side, size_t column, size_t row) {
  std::array<int, 3> sums{};
  int count = 0;
  for (size_t y = row > 0 ? row - 1 : 0; y <= std::min(row + 1, side - 1); ++y) {
    for (size_t x = column > 0 ? column - 1 : 0; x <= std::min(column + 1, side - 1); ++x) {
      const uint8_t* texel = texels + (y * side + x) * sizeof(Texel);
      if (texel[3] == 0) continue;
      for (size_t channel = 0; channel < sums.size(); ++channel) sums[channel] += texel[channel];
      ++count;
    }
  }
  Texel mean{};
  for (size_t channel = 0; channel < sums.size() && count > 0; ++channel) {
    mean[channel] = static_cast<uint8_t>((sums[channel] + count / 2) / count);
  }
  return mean;
}

void ColourRimsOf(uint8_t* texels, size_t side) {
  for (size_t row = 0; row < side; ++row) {
    for (size_t column = 0; column < side; ++column) {
      uint8_t* texel = texels + (row * side + column) * sizeof(Texel);
      if (texel[3] != 0) continue;
      const Texel mean = MeanAround(texels, side, column, row);
      std::copy(mean.begin(), mean.end(), texel);
    }
  }
}

}  // namespace

void FillMipLevels(ImagePage& page) {
  BELVEDERE_CHECK(page.texels.size() == ImagePage::MipOffset(kImageMipLevels, page.format));
  for (int level = 1; level < kImageMipLevels; ++level) {
    const uint8_t* from = page.texels.data() + ImagePage::MipOffset(level - 1, page.format);
    uint8_t* to = page.texels.data() + ImagePage::MipOffset(level, page.format);
    const auto side = static_cast<size_t>(kImageSide >> level);
    if (page.format == ImageFormat::kR8) {
      HalveR8(from, to, side);
    } else {
      HalveRgba8(from, to, side);
    }
  }
}

void ColourRims(ImagePage& page) {
  BELVEDERE_CHECK(page.format == ImageFormat::kRGBA8);
  for (int level = 0; level < kImageMipLevels; ++level) {
    ColourRimsOf(page.texels.data() + ImagePage::MipOffset(level, page.format),
                 static_cast<size_t>(kImageSide >> level));
  }
}

}  // namespace belvedere

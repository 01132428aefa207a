#include "servers/mip_levels.h"

#include "runtime/base/status.h"

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

}  // namespace belvedere

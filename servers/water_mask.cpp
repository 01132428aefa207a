#include "servers/water_mask.h"

#include "servers/mip_levels.h"
#include "servers/texel_heights.h"

#include <algorithm>

namespace belvedere {

std::unique_ptr<ImagePage> MaskWater(const ElevationPage& heights, Quadcode node, const Geoid* sea) {
  auto page = std::make_unique<ImagePage>();
  page->format = ImageFormat::kR8;
  page->texels.resize(ImagePage::MipOffset(kImageMipLevels, page->format));
  uint8_t* texel = page->texels.data();
  for (const TexelHeight& at : HeightsAtTexels(heights, node, sea)) {
    const float height_m = std::max(at.height_m, at.mean_m);
    *texel++ = static_cast<uint8_t>(255 * std::clamp(1 - height_m / kShore_m, 0.0F, 1.0F) + 0.5F);
  }
  FillMipLevels(*page);
  return page;
}

}  // namespace belvedere

#include "servers/quadcode_frame.h"

#include "servers/mip_levels.h"

namespace belvedere {
namespace {

constexpr TexelColour kLine = {255, 210, 60};
constexpr TexelColour kHalo = {20, 20, 20};
constexpr float kCover = 0.8F;

}  // namespace

std::unique_ptr<ImagePage> DrawQuadcodeFrame(Quadcode node, const PageText& text) {
  auto page = MakeTransparentPage(kLine);
  // One texel on either side of the border; the outer one is the inner one of the neighbour.
  const auto on_border = [](int along) {
    return along == kImageGutter - 1 || along == kImageGutter || along == kImageGutter + kImageInner - 1 ||
           along == kImageGutter + kImageInner;
  };
  for (int row = 0; row < kImageSide; ++row) {
    for (int column = 0; column < kImageSide; ++column) {
      if (on_border(row) || on_border(column)) CoverTexel(*page, column, row, kLine, kCover);
    }
  }
  const std::string name = node.ToString();
  text.Write(*page, text.BoxAround(name, kImageSide / 2, kImageSide / 2), name, kLine, kHalo);
  FillMipLevels(*page);
  return page;
}

}  // namespace belvedere

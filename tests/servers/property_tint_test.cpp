#include "servers/property_tint.h"

#include <gtest/gtest.h>

#include <array>

namespace belvedere {
namespace {

constexpr size_t kPlane = static_cast<size_t>(kElevationSide) * static_cast<size_t>(kElevationSide);

std::array<int, 4> Texel(const ImagePage& image, int column, int row) {
  const uint8_t* texel = &image.texels[static_cast<size_t>(4 * (row * kImageSide + column))];
  return {texel[0], texel[1], texel[2], texel[3]};
}

TEST(PropertyTint, ClassesHaveTheirColoursAndNoBlendBetween) {
  PropertyPage page;
  for (size_t i = 0; i < kPlane; ++i) page.values.push_back(i % kElevationSide < kElevationSide / 2 ? 0 : 1);
  PropertyRecord meaning;
  meaning.classes = {{"a", {10, 20, 30, 255}}, {"b", {200, 100, 50, 128}}};
  const auto image = TintProperty(page, meaning);
  for (int column = 0; column < kImageSide; ++column) {
    const std::array<int, 4> expected =
        column < kImageSide / 2 ? std::array{10, 20, 30, 255} : std::array{200, 100, 50, 128};
    if (column == kImageSide / 2 || column == kImageSide / 2 - 1) continue;  // either
    EXPECT_EQ(Texel(*image, column, 100), expected) << column;
  }
  page.values.assign(kPlane, 7);
  EXPECT_EQ(Texel(*TintProperty(page, meaning), 100, 100)[3], 0) << "a byte without a class";
}

TEST(PropertyTint, NumbersAreGreyOrTheirChannels) {
  PropertyPage page;
  page.values.assign(kPlane, 90);
  EXPECT_EQ(Texel(*TintProperty(page, {}), 5, 250), (std::array{90, 90, 90, 255}));
  page.channels = 3;
  page.values.insert(page.values.end(), kPlane, 128);
  page.values.insert(page.values.end(), kPlane, 255);
  EXPECT_EQ(Texel(*TintProperty(page, {}), 0, 0), (std::array{90, 128, 255, 255}));
}

}  // namespace
}  // namespace belvedere

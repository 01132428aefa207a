#include "runtime/paging/page_codec.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <cmath>
#include <random>
#include <string_view>

namespace belvedere {
namespace {

ElevationPage Hills(unsigned seed) {
  std::mt19937 random(seed);
  ElevationPage page;
  page.min_m = -12.5f;
  page.max_m = 4321.25f;
  page.error_m = 7.75f;
  for (size_t block = 0; block < page.block_errors_m.size(); ++block)
    page.block_errors_m[block] = 0.25f * static_cast<float>(block);
  for (int i = 0; i < kElevationSide * kElevationSide; ++i) {
    page.heights_mm.push_back(static_cast<int32_t>(random() % 9000000) - 11000000);
  }
  return page;
}

std::vector<uint8_t> Picture(unsigned seed, bool opaque) {
  std::mt19937 random(seed);
  std::vector<uint8_t> rgba(4 * kImageTexels);
  for (auto& byte : rgba) byte = static_cast<uint8_t>(random());
  for (size_t i = 3; opaque && i < rgba.size(); i += 4) rgba[i] = 255;
  return rgba;
}

TEST(PageCodec, Crc32cIsTheOneOfRfc3720) {
  const std::string_view digits = "123456789";
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(digits.data()), digits.size());
  EXPECT_EQ(Crc32c(bytes), 0xE3069283u);
  EXPECT_EQ(Crc32c(bytes.subspan(4), Crc32c(bytes.first(4))), 0xE3069283u);
  EXPECT_EQ(Crc32c(std::vector<uint8_t>(32, 0)), 0x8A9136AAu);
}

TEST(PageCodec, ElevationComesBackToTheBit) {
  const ElevationPage page = Hills(1);
  const auto back = DecodeElevation(EncodeElevation(page));
  ASSERT_TRUE(back.ok()) << back.message();
  EXPECT_EQ((*back)->heights_mm, page.heights_mm);
  EXPECT_EQ((*back)->min_m, page.min_m);
  EXPECT_EQ((*back)->max_m, page.max_m);
  EXPECT_EQ((*back)->error_m, page.error_m);
  EXPECT_EQ((*back)->block_errors_m, page.block_errors_m);
}

TEST(PageCodec, DeltaValuesComeBackToTheBitWhereThereAreAny) {
  ElevationPage page = Hills(7);
  const auto without = DecodeElevation(EncodeElevation(page));
  ASSERT_TRUE(without.ok()) << without.message();
  EXPECT_TRUE((*without)->deltas.steps.empty());
  std::mt19937 random(8);
  page.deltas.greatest_m = 321.5f;
  for (int i = 0; i < kVerticesPerPage; ++i) page.deltas.steps.push_back(static_cast<uint8_t>(random()));
  const auto with = DecodeElevation(EncodeElevation(page));
  ASSERT_TRUE(with.ok()) << with.message();
  EXPECT_EQ((*with)->deltas, page.deltas);
  EXPECT_EQ((*with)->heights_mm, page.heights_mm);
}

TEST(PageCodec, HeightsThatAreRoundedTakeFewerBytes) {
  ElevationPage page = Hills(1);
  const size_t exact = EncodeElevation(page).size();
  for (int32_t& height_mm : page.heights_mm) height_mm = height_mm / 128 * 128;
  page.heights_mm[7] = -128;
  const std::vector<uint8_t> rounded = EncodeElevation(page);
  EXPECT_EQ(rounded[7], 7) << "the shift";
  EXPECT_LT(rounded.size(), exact * 3 / 4);
  const auto back = DecodeElevation(rounded);
  ASSERT_TRUE(back.ok()) << back.message();
  EXPECT_EQ((*back)->heights_mm, page.heights_mm);
  page.heights_mm.assign(page.heights_mm.size(), 0);
  EXPECT_EQ((*DecodeElevation(EncodeElevation(page)))->heights_mm, page.heights_mm);
  page.heights_mm[9] = INT32_MIN;  // one bit alone
  EXPECT_EQ((*DecodeElevation(EncodeElevation(page)))->heights_mm, page.heights_mm);
}

TEST(PageCodec, ElevationHoldsTheWholeRangeOfInt32) {
  ElevationPage page = Hills(2);
  page.heights_mm[0] = INT32_MIN;
  page.heights_mm[1] = INT32_MAX;
  page.heights_mm.back() = INT32_MIN;
  const auto back = DecodeElevation(EncodeElevation(page));
  ASSERT_TRUE(back.ok()) << back.message();
  EXPECT_EQ((*back)->heights_mm, page.heights_mm);
}

TEST(PageCodec, ImagesComeBackToTheBitWithAndWithoutAlpha) {
  for (const bool opaque : {true, false}) {
    const auto rgba = Picture(3, opaque);
    const auto bytes = EncodeImage(rgba);
    EXPECT_EQ(bytes[6] & 1, opaque ? 0 : 1);
    const auto back = DecodeImage(bytes);
    ASSERT_TRUE(back.ok()) << back.message();
    EXPECT_EQ((*back)->format, ImageFormat::kRGBA8);
    ASSERT_EQ((*back)->texels.size(), ImagePage::MipOffset(kImageMipLevels, ImageFormat::kRGBA8));
    EXPECT_TRUE(std::equal(rgba.begin(), rgba.end(), (*back)->texels.begin()));
  }
}

// The header is written out here; the payload is zstd's, whose bytes may change with its version, so of it only what it
// unpacks to is held, by the tests above.
TEST(PageCodec, PropertiesComeBackToTheBitAndTheirBytesArePinned) {
  std::mt19937 random(9);
  PropertyPage page;
  page.channels = 2;
  for (int i = 0; i < 2 * kElevationSide * kElevationSide; ++i) page.values.push_back(static_cast<uint8_t>(random()));
  const std::vector<uint8_t> bytes = EncodeProperty(page);
  EXPECT_EQ(bytes[5], 4);  // the kind
  EXPECT_EQ(bytes[6], 2);  // flags: channels
  EXPECT_EQ(bytes[7], 0);
  std::vector<uint8_t> raw(page.values.size());
  ASSERT_EQ(ZSTD_decompress(raw.data(), raw.size(), &bytes[kPageHeaderBytes], bytes.size() - kPageHeaderBytes),
            raw.size());
  EXPECT_EQ(raw[0], page.values[0]);
  for (size_t i = 1; i < raw.size(); ++i) ASSERT_EQ(raw[i], static_cast<uint8_t>(page.values[i] - page.values[i - 1]));
  const auto back = DecodeProperty(bytes);
  ASSERT_TRUE(back.ok()) << back.message();
  EXPECT_EQ((*back)->channels, 2);
  EXPECT_EQ((*back)->values, page.values);
  for (size_t i = 0; i < kPageHeaderBytes; ++i) {
    std::vector<uint8_t> damaged = bytes;
    damaged[i] ^= 0x15;
    EXPECT_FALSE(DecodeProperty(damaged).ok()) << i;
  }
  EXPECT_FALSE(DecodeProperty(std::span(bytes).first(bytes.size() - 1)).ok());
  EXPECT_FALSE(DecodeProperty(WrapPage(4, 9, raw, 1)).ok()) << "nine channels";
  EXPECT_FALSE(DecodeProperty(WrapPage(4, 1, raw, 1)).ok()) << "of another size";
  EXPECT_FALSE(DecodeImage(bytes).ok());
}

TEST(PageCodec, HeaderBytesArePinned) {
  ElevationPage flat;
  flat.heights_mm.assign(static_cast<size_t>(kElevationSide) * kElevationSide, 0);
  const auto bytes = EncodeElevation(flat);
  const auto payload = static_cast<uint32_t>(bytes.size() - kPageHeaderBytes);
  ASSERT_LT(payload, 65536u);
  constexpr uint32_t kRaw = 4 * (3 + 16 * 16) + 4 * 133 * 133;
  const std::vector<uint8_t> expected = {'B',
                                         'V',
                                         'P',
                                         'G',
                                         1,
                                         1,
                                         0,
                                         0,  // magic, version, kind, flags
                                         kRaw & 0xFF,
                                         (kRaw >> 8) & 0xFF,
                                         (kRaw >> 16) & 0xFF,
                                         0,
                                         static_cast<uint8_t>(payload & 0xFF),
                                         static_cast<uint8_t>(payload >> 8),
                                         0,
                                         0};
  EXPECT_EQ(std::vector<uint8_t>(bytes.begin(), bytes.begin() + 16), expected);
  const std::span<const uint8_t> all(bytes);
  const uint32_t crc = Crc32c(all.subspan(20), Crc32c(all.first(16)));
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(bytes[16 + i], static_cast<uint8_t>(crc >> (8 * i)));
}

// As docs/dataset-format.md has it.
TEST(PageCodec, BytesOfDeltaValuesArePinned) {
  ElevationPage flat;
  flat.heights_mm.assign(static_cast<size_t>(kElevationSide) * kElevationSide, 0);
  flat.deltas = {1.0f, std::vector<uint8_t>(kVerticesPerPage, 100)};
  flat.deltas.steps[0] = 1;                     // the south-west corner,
  flat.deltas.steps[kVerticesPerPage - 1] = 4;  // the north-east one,
  flat.deltas.steps[64 * kPosts + 64] = 30;     // the middle of the page, whose parents are the others,
  flat.deltas.steps[64] = 70;                   // and the middles of two sides
  flat.deltas.steps[64 * kPosts] = 20;
  const auto bytes = EncodeElevation(flat);
  EXPECT_EQ(bytes[6], 2);
  constexpr size_t kBefore = 4 * (3 + 16 * 16) + 4 * 133 * 133;
  constexpr size_t kRaw = kBefore + 4 + 129 * 129;
  std::vector<uint8_t> raw(kRaw);
  ASSERT_EQ(ZSTD_decompress(raw.data(), kRaw, &bytes[kPageHeaderBytes], bytes.size() - kPageHeaderBytes), kRaw);
  const std::vector<uint8_t> start(raw.begin() + kBefore, raw.begin() + kBefore + 14);
  const std::vector<uint8_t> expected{0,
                                      0,
                                      128,
                                      63,  // 1.0f
                                      1,
                                      100,
                                      100,
                                      4,  // corners
                                      static_cast<uint8_t>(30 - 100),
                                      70 - 30,
                                      static_cast<uint8_t>(20 - 30),
                                      70,
                                      70,                               // south, west, east, north
                                      static_cast<uint8_t>(100 - 20)};  // the middle of the south-western quarter
  EXPECT_EQ(start, expected);
}

TEST(PageCodec, EveryDamagedByteIsNoticed) {
  ElevationPage page = Hills(4);
  page.deltas = {12.5f, std::vector<uint8_t>(kVerticesPerPage, 3)};
  const auto good = EncodeElevation(page);
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    auto bad = good;
    const size_t at = i < 20 ? static_cast<size_t>(i) : random() % bad.size();
    bad[at] = static_cast<uint8_t>(bad[at] ^ (1 + random() % 255));
    const auto back = DecodeElevation(bad);
    EXPECT_FALSE(back.ok()) << "byte " << at;
    EXPECT_FALSE(back.message().empty());
  }
}

TEST(PageCodec, CutAndForeignBytesAreRefused) {
  const auto good = EncodeImage(Picture(6, false));
  for (const size_t length : {size_t{0}, size_t{7}, size_t{19}, size_t{20}, good.size() / 2, good.size() - 1}) {
    EXPECT_FALSE(DecodeImage(std::span(good).first(length)).ok());
  }
  EXPECT_FALSE(DecodeElevation(good).ok()) << "an image is no elevation";
  auto newer = good;
  newer[4] = 9;
  EXPECT_NE(DecodeImage(newer).message().find("version 9"), std::string::npos);
}

}  // namespace
}  // namespace belvedere

#include "preproc/deviation_codec.h"

#include "runtime/paging/page_envelope.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <limits>
#include <random>

namespace belvedere {
namespace {

CellDeviations Deviations() {
  std::mt19937 random(4);
  CellDeviations deviations(static_cast<size_t>(kCells) * kCells);
  for (Deviation& cell : deviations) {
    cell.low = -static_cast<int32_t>(random() % 100000);
    cell.high = static_cast<int32_t>(random() >> 1);
  }
  deviations[0] = {std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max()};
  deviations[1] = {5, -5};
  return deviations;
}

TEST(DeviationCodec, WhatIsEncodedIsDecoded) {
  const CellDeviations deviations = Deviations();
  const auto decoded = DecodeDeviations(EncodeDeviations(deviations));
  ASSERT_TRUE(decoded.ok()) << decoded.message();
  ASSERT_EQ(decoded->size(), deviations.size());
  for (size_t cell = 0; cell < deviations.size(); ++cell) {
    EXPECT_EQ((*decoded)[cell].low, deviations[cell].low);
    EXPECT_EQ((*decoded)[cell].high, deviations[cell].high);
  }
}

TEST(DeviationCodec, BadBytesAreRefused) {
  const std::vector<uint8_t> good = EncodeDeviations(Deviations());
  for (const size_t at : {size_t{0}, size_t{5}, size_t{8}, good.size() / 2, good.size() - 1}) {
    std::vector<uint8_t> bad = good;
    bad[at] ^= 0x10;
    EXPECT_FALSE(DecodeDeviations(bad).ok()) << at;
  }
  for (const size_t size : {size_t{0}, size_t{7}, size_t{8}, good.size() - 1}) {
    EXPECT_FALSE(DecodeDeviations({good.data(), size}).ok()) << size;
  }
}

// As docs/dataset-format.md has it, with a number that is whole in 64 bits alone.
TEST(DeviationCodec, WhatIsTooFarForTheEarthIsRefused) {
  std::vector<uint8_t> raw(static_cast<size_t>(kCells) * kCells * 16);
  const auto encoded = [&] {
    std::vector<uint8_t> packed(ZSTD_compressBound(raw.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), 1));
    const uint32_t crc = Crc32c(packed);
    std::vector<uint8_t> bytes{'B', 'V', 'D', 'V'};
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<uint8_t>(crc >> (8 * i)));
    bytes.insert(bytes.end(), packed.begin(), packed.end());
    return bytes;
  };
  ASSERT_TRUE(DecodeDeviations(encoded()).ok());
  raw[4 * static_cast<size_t>(kCells) * kCells] = 2;  // byte 4 of the first cell's low: 2^32
  const auto refused = DecodeDeviations(encoded());
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.message().find("thousand kilometres"), std::string::npos) << refused.message();
}

}  // namespace
}  // namespace belvedere

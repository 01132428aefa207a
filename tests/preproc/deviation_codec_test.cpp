#include "preproc/deviation_codec.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace belvedere

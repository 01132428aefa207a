// What a test reads out of the pages of a dataset that it built. The dataset's first layer is meant.
#pragma once

#include "runtime/paging/dataset.h"
#include "runtime/paging/page.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace belvedere::testing_rasters {

inline double HeightAt(const Dataset& dataset, double latitude, double longitude, int max_level = kMaxLevel) {
  const Quadcode node = dataset.FinestContaining(0, latitude, longitude, max_level);
  const auto page = dataset.ReadElevation(0, node);
  EXPECT_TRUE(page.ok()) << page.message();
  return page.ok() ? BilinearHeight(**page, node, latitude, longitude) : 0;
}

// Every post that two pages of a level hold, aprons included, is the same in both.
inline void ExpectSharedPosts(const Dataset& dataset) {
  for (const uint64_t word : dataset.Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    const auto page = dataset.ReadElevation(0, node);
    ASSERT_TRUE(page.ok()) << page.message();
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
      if (node.row() + dy >= (int64_t{kTreeRows} << node.level())) continue;
      const Quadcode other = Quadcode::FromColumnRow(node.level(), node.column() + dx, node.row() + dy);
      if (!dataset.Exists(0, other) || other.Doublings() != node.Doublings()) continue;
      const auto theirs = dataset.ReadElevation(0, other);
      ASSERT_TRUE(theirs.ok());
      for (int row = dy * kCells - kApron; row < kPosts + kApron; ++row) {
        for (int column = dx * kCells - kApron; column < kPosts + kApron; ++column) {
          if (row - dy * kCells >= kPosts + kApron || column - dx * kCells >= kPosts + kApron) continue;
          ASSERT_EQ((*page)->at(column, row), (*theirs)->at(column - dx * kCells, row - dy * kCells))
              << node.ToString() << " " << other.ToString() << " " << column << " " << row;
        }
      }
    }
  }
}

inline std::array<int, 4> TexelAt(const Dataset& dataset, double latitude, double longitude,
                                  int max_level = kMaxLevel) {
  const Quadcode node = dataset.FinestContaining(0, latitude, longitude, max_level);
  const auto page = dataset.ReadImage(0, node);
  EXPECT_TRUE(page.ok()) << page.message();
  const GeoBox box = node.Box();
  const int column = kImageGutter + static_cast<int>((longitude - box.west_deg) / node.WidthDegrees() * kImageInner);
  const int row = kImageGutter + static_cast<int>((latitude - box.south_deg) / node.HeightDegrees() * kImageInner);
  const uint8_t* texel = &(*page)->texels[static_cast<size_t>(4 * (row * kImageSide + column))];
  return {texel[0], texel[1], texel[2], texel[3]};
}

}  // namespace belvedere::testing_rasters

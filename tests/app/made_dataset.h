// A small dataset that a test makes for the programs to open: plain heights and a plain colour.
//
//   elevation  the 32 roots, all posts kPlainHeight_m, and the four children of root 20 (0 N, 0 E to 45 N, 45 E), 100 m
//   higher imagery    the 32 roots, one colour
#pragma once

#include "runtime/paging/dataset_writer.h"
#include "runtime/paging/page_codec.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace belvedere {

inline constexpr int kPlainHeight_m = 200;

class MadeDataset {
 public:
  explicit MadeDataset(const std::string& name)
      : path_(testing::TempDir() + "belvedere_" + name + "_" + std::to_string(getpid())) {
    Result<std::unique_ptr<DatasetWriter>> writer = DatasetWriter::Create(path_);
    BELVEDERE_CHECK(writer.ok());
    for (int tree = 0; tree < kTrees; ++tree) PutHeights(**writer, Quadcode::Root(tree), kPlainHeight_m);
    for (int child = 0; child < 4; ++child) PutHeights(**writer, Quadcode::Root(20).Child(child), kPlainHeight_m + 100);
    std::vector<uint8_t> rgba;
    for (size_t i = 0; i < kImageTexels; ++i) rgba.insert(rgba.end(), {60, 120, 60, 255});
    const std::vector<uint8_t> image = EncodeImage(rgba);
    for (int tree = 0; tree < kTrees; ++tree) BELVEDERE_CHECK((*writer)->Put(1, Quadcode::Root(tree), image).ok());
    LayerRecord elevation, imagery;
    elevation.name = "elevation";
    elevation.max_level = 1;
    imagery.name = "imagery";
    imagery.kind = LayerKind::kImagery;
    BELVEDERE_CHECK((*writer)->Finish({elevation, imagery}, "2026-01-01T00:00:00Z").ok());
  }
  ~MadeDataset() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  MadeDataset(const MadeDataset&) = delete;
  MadeDataset& operator=(const MadeDataset&) = delete;

  const std::string& path() const { return path_; }

 private:
  static void PutHeights(DatasetWriter& writer, Quadcode node, int height_m) {
    ElevationPage page;
    page.heights_mm.assign(static_cast<size_t>(kElevationSide * kElevationSide), height_m * 1000);
    page.min_m = static_cast<float>(height_m);
    page.max_m = static_cast<float>(kPlainHeight_m + 100);
    page.error_m = node == Quadcode::Root(20) ? 100.0F : 0.0F;
    BELVEDERE_CHECK(writer.Put(0, node, EncodeElevation(page)).ok());
  }

  const std::string path_;
};

}  // namespace belvedere

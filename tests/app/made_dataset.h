// A small dataset that a test makes for the programs to open: plain heights and a plain colour.
//
//   elevation  the 32 roots, all posts kPlainHeight_m, and the four children of root 20 (0 N, 0 E to 45 N, 45 E), 100 m
//   higher
//   imagery    the 32 roots, one colour; or, where it is asked for, green from the 1st of March of every year on and
//              white from the 1st of November
#pragma once

#include "runtime/base/iso_time.h"
#include "runtime/paging/dataset_writer.h"
#include "runtime/paging/page_codec.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace belvedere {

inline constexpr int kPlainHeight_m = 200;

class MadeDataset {
 public:
  explicit MadeDataset(const std::string& name, bool seasons = false)
      : path_(testing::TempDir() + "belvedere_" + name + "_" + std::to_string(getpid())) {
    Result<std::unique_ptr<DatasetWriter>> writer = DatasetWriter::Create(path_);
    BELVEDERE_CHECK(writer.ok());
    for (int tree = 0; tree < kTrees; ++tree) PutHeights(**writer, Quadcode::Root(tree), kPlainHeight_m);
    for (int child = 0; child < 4; ++child) PutHeights(**writer, Quadcode::Root(20).Child(child), kPlainHeight_m + 100);
    PutColour(**writer, 1, {60, 120, 60, 255});
    LayerRecord elevation, imagery;
    elevation.name = "elevation";
    elevation.max_level = 1;
    imagery.name = "imagery";
    imagery.kind = LayerKind::kImagery;
    std::vector<LayerRecord> layers{elevation, imagery};
    if (seasons) {
      PutColour(**writer, 2, {240, 240, 240, 255});
      layers.push_back(imagery);
      for (const auto& [layer, time] : {std::pair{1U, "2004-03-01T00:00:00Z"}, std::pair{2U, "2004-11-01T00:00:00Z"}}) {
        layers[layer].name = std::string("imagery@") + time;
        layers[layer].step = StepOf{"imagery", *ParseIsoTime(time), Repeats::kEveryYear};
      }
    }
    BELVEDERE_CHECK((*writer)->Finish(std::move(layers), "2026-01-01T00:00:00Z").ok());
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

  static void PutColour(DatasetWriter& writer, int layer, const std::array<uint8_t, 4>& colour) {
    std::vector<uint8_t> rgba;
    for (size_t i = 0; i < kImageTexels; ++i) rgba.insert(rgba.end(), colour.begin(), colour.end());
    const std::vector<uint8_t> image = EncodeImage(rgba);
    for (int tree = 0; tree < kTrees; ++tree) BELVEDERE_CHECK(writer.Put(layer, Quadcode::Root(tree), image).ok());
  }

  const std::string path_;
};

}  // namespace belvedere

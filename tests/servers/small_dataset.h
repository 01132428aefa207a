// A small dataset for tests: heights by formula and plain colours, in a folder of the test's own.
//
//   elevation  the 32 roots, the four children of root 20, and the four of its child 3
//   imagery    the 32 roots and the four children of root 21
//   seasons    where it is asked for: steps of one grey each, the 32 roots
#pragma once

#include "runtime/paging/dataset.h"
#include "runtime/paging/dataset_writer.h"
#include "runtime/paging/page_codec.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace belvedere {

struct SmallDatasetOptions {
  std::string elevation_name = "elevation";
  bool has_elevation = true;
  std::vector<uint8_t> season_greys;  // of each step
  std::string seasons_name = "seasons";
  Quadcode damaged = Quadcode::Root(0).Child(0);  // its elevation page is stored with a wrong checksum, if it is there
};

class SmallDataset {
 public:
  explicit SmallDataset(const SmallDatasetOptions& options = {}) {
    static int number = 0;
    path_ = testing::TempDir() + "belvedere_small_" + std::to_string(getpid()) + "_" + std::to_string(number++);
    Result<std::unique_ptr<DatasetWriter>> writer = DatasetWriter::Create(path_);
    BELVEDERE_CHECK(writer.ok());
    std::vector<LayerRecord> layers;
    if (options.has_elevation) {
      PutElevation(**writer, options);
      layers.push_back(Record(options.elevation_name, LayerKind::kElevation, 2));
    }
    PutImagery(**writer, static_cast<int>(layers.size()));
    layers.push_back(Record("imagery", LayerKind::kImagery, 1));
    for (size_t step = 0; step < options.season_greys.size(); ++step) {
      PutSeason(**writer, static_cast<int>(layers.size()), options.season_greys[step]);
      layers.push_back(Record(options.seasons_name + "@" + std::to_string(step), LayerKind::kImagery, 0));
      layers.back().step = StepOf{options.seasons_name, SeasonTime(step), Repeats::kNever};
    }
    BELVEDERE_CHECK((*writer)->Finish(layers, "2026-01-01T00:00:00Z").ok());
    Result<std::unique_ptr<Dataset>> opened = Dataset::Open(path_);
    BELVEDERE_CHECK(opened.ok());
    dataset_ = std::move(*opened);
  }
  ~SmallDataset() {
    dataset_.reset();
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  SmallDataset(const SmallDataset&) = delete;
  SmallDataset& operator=(const SmallDataset&) = delete;

  const Dataset& operator*() const { return *dataset_; }
  const std::string& path() const { return path_; }
  static double SeasonTime(size_t step) { return 8e6 * static_cast<double>(step); }

 private:
  static LayerRecord Record(const std::string& name, LayerKind kind, int max_level) {
    LayerRecord record;
    record.name = name;
    record.kind = kind;
    record.max_level = max_level;
    return record;
  }

  static void PutElevation(DatasetWriter& writer, const SmallDatasetOptions& options) {
    const auto put = [&](Quadcode node) {
      auto page = MakeElevation(node, WavyHeight);
      page->error_m = node.level() < 2 ? 50 : 0;
      page->block_errors_m.fill(page->error_m);
      std::vector<uint8_t> value = EncodeElevation(*page);
      if (node == options.damaged) value.back() ^= 0x5A;
      BELVEDERE_CHECK(writer.Put(0, node, value).ok());
    };
    for (int tree = 0; tree < kTrees; ++tree) put(Quadcode::Root(tree));
    for (int child = 0; child < 4; ++child) {
      put(Quadcode::Root(20).Child(child));
      put(Quadcode::Root(20).Child(3).Child(child));
    }
  }

  static void PutSeason(DatasetWriter& writer, int layer, uint8_t grey) {
    const std::vector<uint8_t> value = EncodeImage(std::vector<uint8_t>(kImageTexels * 4, grey));
    for (int tree = 0; tree < kTrees; ++tree) BELVEDERE_CHECK(writer.Put(layer, Quadcode::Root(tree), value).ok());
  }

  static void PutImagery(DatasetWriter& writer, int layer) {
    std::vector<uint8_t> texels(kImageTexels * 4);
    for (size_t i = 0; i < texels.size(); ++i)
      texels[i] = i % 4 == 3 ? uint8_t{255} : static_cast<uint8_t>(40 * (i % 4));
    const std::vector<uint8_t> value = EncodeImage(texels);
    for (int tree = 0; tree < kTrees; ++tree) BELVEDERE_CHECK(writer.Put(layer, Quadcode::Root(tree), value).ok());
    for (int child = 0; child < 4; ++child)
      BELVEDERE_CHECK(writer.Put(layer, Quadcode::Root(21).Child(child), value).ok());
  }

  std::string path_;
  std::unique_ptr<Dataset> dataset_;
};

}  // namespace belvedere

// What tests of changes to a dataset share: its pages, the changes, and what it should have become.
#pragma once

#include "preproc/dataset_spec.h"
#include "preproc/report.h"
#include "preproc/update.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace belvedere::testing_rasters {

namespace fs = std::filesystem;

using Pages = std::map<std::pair<int, uint64_t>, std::pair<std::vector<uint8_t>, std::vector<uint8_t>>>;

inline BuildOptions OptionsFor(const std::string& folder) {
  BuildOptions options;
  options.out = folder + "/out";
  options.jobs = 2;
  options.batch_bytes = 1 << 18;
  options.show_progress = false;
  return options;
}

inline BuildSpec SpecFrom(const std::string& folder, const std::string& text) {
  auto spec = ParseSpec(text, folder + "/spec.toml");
  EXPECT_TRUE(spec.ok()) << spec.message();
  return std::move(*spec);
}

inline Result<BuildReport> Add(const std::string& folder, const std::string& text) {
  return Update([&](BuildSpec spec) { return WithAdded(std::move(spec), SpecFrom(folder, text)); }, OptionsFor(folder),
                Clock::System());
}

inline Result<BuildReport> Remove(const std::string& folder, const std::string& source, const std::string& layer = {}) {
  return Update([&](BuildSpec spec) { return WithRemoved(std::move(spec), source, layer); }, OptionsFor(folder),
                Clock::System());
}

inline Result<BuildReport> Refresh(const std::string& folder) {
  return Update([](BuildSpec spec) -> Result<BuildSpec> { return spec; }, OptionsFor(folder), Clock::System());
}

// Raster of noise; the same for the same seed. The heights of one band are under so many metres: where the posts are
// far apart, 40 ask for no finer pages.
inline void Noise(const std::string& path, unsigned seed, int width, int height, const std::array<double, 6>& affine,
                  int bands = 1, unsigned range_m = 3000) {
  std::mt19937 random(seed);
  Write(path, {.width = width,
               .height = height,
               .bands = bands,
               .type = bands == 1 ? GDT_Float32 : GDT_Byte,
               .affine = affine,
               .value = [&](int, int, int) { return static_cast<double>(random() % (bands == 1 ? range_m : 256)); }});
}

// What is in the store, deviations too, and that its records count it.
inline Pages PagesOf(const std::string& folder) {
  Pages pages;
  const auto dataset = MustOpen(folder);
  if (dataset == nullptr) return pages;
  EXPECT_TRUE(VerifyDataset(*dataset).problems.empty());
  for (int layer = 0; layer < static_cast<int>(dataset->layers().size()); ++layer) {
    const LayerRecord& record = dataset->layers()[static_cast<size_t>(layer)];
    int64_t bytes = 0;
    std::vector<int64_t> per_level;
    for (const uint64_t word : dataset->Nodes(layer)) {
      const Quadcode node = *Quadcode::FromWord(word);
      auto page = dataset->ReadRaw(layer, node).value_or(std::vector<uint8_t>());
      bytes += static_cast<int64_t>(page.size());
      per_level.resize(std::max(per_level.size(), static_cast<size_t>(node.level()) + 1));
      ++per_level[static_cast<size_t>(node.level())];
      pages[{layer, word}] = {std::move(page), dataset->ReadDeviations(layer, node).value_or(std::vector<uint8_t>())};
    }
    EXPECT_EQ(record.pages, static_cast<int64_t>(dataset->Nodes(layer).size())) << record.name;
    EXPECT_EQ(record.bytes, bytes) << record.name;
    EXPECT_EQ(record.pages_per_level, per_level) << record.name;
    EXPECT_EQ(record.max_level, static_cast<int>(per_level.size()) - 1) << record.name;
  }
  return pages;
}

// Pages of `after` that `before` has not, or with other bytes.
inline int64_t CountNew(const Pages& before, const Pages& after) {
  int64_t count = 0;
  for (const auto& [key, value] : after) {
    const auto found = before.find(key);
    count += found == before.end() || found->second.first != value.first;
  }
  return count;
}

inline Pages BuiltWhole(const std::string& name, const std::string& sources, const std::string& text) {
  const std::string folder = FreshFolder(name);
  fs::copy(sources, folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  MustBuild(folder, text);
  return PagesOf(folder);
}

inline void ExpectSame(const Pages& changed, const Pages& whole) {
  ASSERT_EQ(changed.size(), whole.size());
  for (const auto& [key, value] : whole) {
    const auto found = changed.find(key);
    const std::string name = Quadcode::FromWord(key.second)->ToString();
    ASSERT_TRUE(found != changed.end()) << name;
    EXPECT_TRUE(found->second.first == value.first) << "layer " << key.first << ", quadnode " << name;
    EXPECT_TRUE(found->second.second == value.second) << "deviations of " << name;
  }
}

}  // namespace belvedere::testing_rasters

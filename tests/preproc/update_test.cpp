// A dataset that is changed has the pages of one that is built of the same sources, and no page is written that is the
// same as before.

#include "preproc/update.h"

#include "preproc/changed_extents.h"
#include "preproc/dataset_spec.h"
#include "preproc/report.h"
#include "tests/preproc/in_child.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

using Pages = std::map<std::pair<int, uint64_t>, std::pair<std::vector<uint8_t>, std::vector<uint8_t>>>;

BuildOptions OptionsFor(const std::string& folder) {
  BuildOptions options;
  options.out = folder + "/out";
  options.jobs = 2;
  options.batch_bytes = 1 << 18;
  options.show_progress = false;
  return options;
}

BuildSpec SpecFrom(const std::string& folder, const std::string& text) {
  auto spec = ParseSpec(text, folder + "/spec.toml");
  EXPECT_TRUE(spec.ok()) << spec.message();
  return std::move(*spec);
}

Result<BuildReport> Add(const std::string& folder, const std::string& text) {
  return Update([&](BuildSpec spec) { return WithAdded(std::move(spec), SpecFrom(folder, text)); }, OptionsFor(folder),
                Clock::System());
}

Result<BuildReport> Remove(const std::string& folder, const std::string& source, const std::string& layer = {}) {
  return Update([&](BuildSpec spec) { return WithRemoved(std::move(spec), source, layer); }, OptionsFor(folder),
                Clock::System());
}

Result<BuildReport> Refresh(const std::string& folder) {
  return Update([](BuildSpec spec) -> Result<BuildSpec> { return spec; }, OptionsFor(folder), Clock::System());
}

// Raster of noise; the same for the same seed.
void Noise(const std::string& path, unsigned seed, int width, int height, const std::array<double, 6>& affine,
           int bands = 1) {
  std::mt19937 random(seed);
  Write(path, {.width = width,
               .height = height,
               .bands = bands,
               .type = bands == 1 ? GDT_Float32 : GDT_Byte,
               .affine = affine,
               .value = [&](int, int, int) { return static_cast<double>(random() % (bands == 1 ? 3000 : 256)); }});
}

// What is in the store, deviations too, and that its records count it.
Pages PagesOf(const std::string& folder) {
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
int64_t CountNew(const Pages& before, const Pages& after) {
  int64_t count = 0;
  for (const auto& [key, value] : after) {
    const auto found = before.find(key);
    count += found == before.end() || found->second.first != value.first;
  }
  return count;
}

Pages BuiltWhole(const std::string& name, const std::string& sources, const std::string& text) {
  const std::string folder = FreshFolder(name);
  fs::copy(sources, folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  MustBuild(folder, text);
  return PagesOf(folder);
}

void ExpectSame(const Pages& changed, const Pages& whole) {
  ASSERT_EQ(changed.size(), whole.size());
  for (const auto& [key, value] : whole) {
    const auto found = changed.find(key);
    const std::string name = Quadcode::FromWord(key.second)->ToString();
    ASSERT_TRUE(found != changed.end()) << name;
    EXPECT_TRUE(found->second.first == value.first) << "layer " << key.first << ", quadnode " << name;
    EXPECT_TRUE(found->second.second == value.second) << "deviations of " << name;
  }
}

struct Inset {
  const char* what;
  std::array<double, 6> affine;
  int width, height;
};
// Each where pages hold posts of others: within one, on borders of trees, over 180 E, at a pole.
const Inset kInsets[] = {{"within", Degrees(11.2, 47.9, 0.01), 60, 40},
                         {"tree_corner", Degrees(44.8, 0.25, 0.01), 40, 50},
                         {"over_180", Degrees(179.7, -10, 0.01), 60, 40},
                         {"pole", Degrees(-30, 90, 0.02), 50, 30},
                         {"border_of_quadnodes", Degrees(22.5, 22.5, 0.01), 30, 30}};

TEST(Update, AddedAndRemovedIsAsIfBuiltSo) {
  for (const Inset& inset : kInsets) {
    SCOPED_TRACE(inset.what);
    const std::string folder = FreshFolder(std::string("update_") + inset.what);
    Noise(folder + "/world.tif", 1, 256, 128, Degrees(-180, 90, 360.0 / 256));
    Noise(folder + "/colours.tif", 2, 256, 128, Degrees(-180, 90, 360.0 / 256), 3);
    Noise(folder + "/inset.tif", 3, inset.width, inset.height, inset.affine);
    Noise(folder + "/photo.tif", 4, inset.width, inset.height, inset.affine, 3);
    const std::string world = "path = \"world.tif\"", colours = "path = \"colours.tif\"";
    const std::string fine = "path = \"inset.tif\"\nfeather_m = 500\ndatum = \"ellipsoid\"",
                      photo = "path = \"photo.tif\"";
    MustBuild(folder, Layer("elevation", {world}) + Layer("imagery", {colours}));
    const Pages before = PagesOf(folder);

    const auto added = Add(folder, Layer("elevation", {fine}) + Layer("imagery", {photo}));
    ASSERT_TRUE(added.ok()) << added.message();
    const Pages after = PagesOf(folder);
    ExpectSame(after, BuiltWhole("update_whole", folder,
                                 Layer("elevation", {world, fine}) + Layer("imagery", {colours, photo})));
    EXPECT_EQ(added->written, CountNew(before, after)) << "only what differs is written";
    EXPECT_GT(added->written, 8);
    EXPECT_EQ(added->removed, 0);

    const auto removed = Remove(folder, "inset.tif");
    ASSERT_TRUE(removed.ok()) << removed.message();
    ExpectSame(PagesOf(folder),
               BuiltWhole("update_whole", folder, Layer("elevation", {world}) + Layer("imagery", {colours, photo})));
    ASSERT_TRUE(Remove(folder, folder + "/photo.tif", "imagery").ok());
    ExpectSame(PagesOf(folder), before);
  }
}

TEST(Update, OnlyWhatTheSourceCoversIsRead) {
  const std::string folder = FreshFolder("update_covered");
  Noise(folder + "/world.tif", 1, 2048, 1024, Degrees(-180, 90, 360.0 / 2048));
  Noise(folder + "/inset.tif", 3, 40, 40, Degrees(11.2, 47.9, 0.01));
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
  const Pages before = PagesOf(folder);
  ASSERT_TRUE(Add(folder, Layer("elevation", {"path = \"inset.tif\""})).ok());
  const std::vector<GeoBox> extent = {MustOpen(folder)->layers()[0].sources.at(1).extent};
  int touched = 0, others = 0;
  for (const auto& [key, value] : PagesOf(folder)) {
    const Quadcode node = *Quadcode::FromWord(key.second);
    if (Touches(extent, LayerKind::kElevation, node) || !before.contains(key)) {
      ++touched;
      EXPECT_TRUE(node.is_root() || Touches(extent, LayerKind::kElevation, node.Parent())) << node.ToString();
    } else {
      ++others;
      EXPECT_TRUE(before.at(key) == value) << node.ToString();
    }
  }
  EXPECT_GT(touched, 8);
  EXPECT_GT(others, 100);
}

TEST(Update, ASourceInTheMiddleIsRemoved) {
  const std::string folder = FreshFolder("update_middle");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128));
  Noise(folder + "/middle.tif", 2, 60, 60, Degrees(10, 50, 0.02));
  Noise(folder + "/top.tif", 3, 40, 40, Degrees(10.5, 49.8, 0.01));
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\"", "path = \"middle.tif\"", "path = \"top.tif\""}));
  ASSERT_TRUE(Remove(folder, "middle.tif").ok());
  ExpectSame(PagesOf(folder),
             BuiltWhole("update_whole", folder, Layer("elevation", {"path = \"world.tif\"", "path = \"top.tif\""})));
}

TEST(Update, ASourceThatHasChangedIsReadAnew) {
  const std::string folder = FreshFolder("update_changed");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128));
  Noise(folder + "/inset.tif", 2, 60, 60, Degrees(10, 50, 0.02));
  const std::string text = Layer("elevation", {"path = \"world.tif\"", "path = \"inset.tif\""});
  MustBuild(folder, text);
  const Pages before = PagesOf(folder);
  const auto nothing = Refresh(folder);
  ASSERT_TRUE(nothing.ok()) << nothing.message();
  EXPECT_EQ(nothing->written, 0);
  EXPECT_FALSE(fs::exists(folder + "/out/change-1.mdb"));
  // It moves: what it covered goes back to the world, what it covers comes.
  Noise(folder + "/inset.tif", 5, 50, 60, Degrees(100, -20, 0.02));
  const auto changed = Refresh(folder);
  ASSERT_TRUE(changed.ok()) << changed.message();
  EXPECT_GT(changed->removed, 0);
  const Pages after = PagesOf(folder);
  EXPECT_EQ(changed->written, CountNew(before, after));
  ExpectSame(after, BuiltWhole("update_whole", folder, text));
}

// What lies below a void is shifted to meet its rims, so that a change on the rim reaches all over it.
TEST(Update, VoidsOverWhatChangesAreFilledAnew) {
  const std::string folder = FreshFolder("update_voids");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128));
  Noise(folder + "/rim.tif", 2, 40, 60, Degrees(10, 50.3, 0.02));
  Write(folder + "/holed.tif",
        {.width = 90,
         .height = 90,
         .affine = Degrees(10.4, 50, 0.02),
         .value =
             [](int, int column, int row) {
               return column > 12 && column < 60 && row > 30 && row < 70 ? -9999.0 : 500.0 + 3 * column + row;
             },
         .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-9999); }});
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\"", "path = \"rim.tif\"", "path = \"holed.tif\""}));
  ASSERT_TRUE(Remove(folder, "rim.tif").ok());
  ExpectSame(PagesOf(folder),
             BuiltWhole("update_whole", folder, Layer("elevation", {"path = \"world.tif\"", "path = \"holed.tif\""})));
}

TEST(Update, ColoursAreMatchedToWhatLiesBelowNow) {
  const std::string folder = FreshFolder("update_colours");
  Noise(folder + "/world.tif", 1, 512, 256, Degrees(-180, 90, 360.0 / 512), 3);
  Noise(folder + "/below.tif", 2, 100, 100, Degrees(10, 50, 0.04), 3);
  Write(folder + "/photo.tif",
        {.width = 200,
         .height = 200,
         .bands = 3,
         .type = GDT_Byte,
         .affine = Degrees(9, 51, 0.04),
         .value = [](int band, int column, int row) { return band * 20.0 + (column + row) / 4; }});
  const std::string photo = "path = \"photo.tif\"\nmatch_colour = true";
  MustBuild(folder, Layer("imagery", {"path = \"world.tif\"", "path = \"below.tif\"", photo}));
  const auto before = MustOpen(folder)->layers()[0].sources.at(2).colour_fit;
  ASSERT_TRUE(before);
  ASSERT_TRUE(Remove(folder, "below.tif").ok());
  const auto after = MustOpen(folder)->layers()[0].sources.at(1).colour_fit;
  ASSERT_TRUE(after);
  EXPECT_NE(after->offset, before->offset);
  ExpectSame(PagesOf(folder), BuiltWhole("update_whole", folder, Layer("imagery", {"path = \"world.tif\"", photo})));
}

TEST(Update, TheFinestStaysLastWhereTheSpecAskedForIt) {
  const std::string folder = FreshFolder("update_priority");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128));
  Noise(folder + "/fine.tif", 2, 60, 60, Degrees(10, 50, 0.01));
  Noise(folder + "/coarse.tif", 3, 60, 60, Degrees(10, 50, 0.03));
  const auto by_resolution = [](const std::vector<std::string>& sources) {
    std::string text = Layer("elevation", sources);
    return text.insert(text.find("kind"), "priority = \"resolution\"\n");
  };
  MustBuild(folder, by_resolution({"path = \"fine.tif\"", "path = \"world.tif\""}));
  ASSERT_TRUE(Add(folder, Layer("elevation", {"path = \"coarse.tif\""})).ok());
  ExpectSame(PagesOf(folder),
             BuiltWhole("update_whole", folder,
                        by_resolution({"path = \"fine.tif\"", "path = \"world.tif\"", "path = \"coarse.tif\""})));
}

TEST(Update, StepsAndNewLayers) {
  const std::string folder = FreshFolder("update_steps");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128), 3);
  Noise(folder + "/winter.tif", 2, 128, 64, Degrees(-180, 90, 360.0 / 128), 3);
  Noise(folder + "/inset.tif", 3, 30, 30, Degrees(10, 50, 0.05), 3);
  Noise(folder + "/heights.tif", 4, 128, 64, Degrees(-180, 90, 360.0 / 128));
  const std::string summer = "path = \"world.tif\"\ntime = \"2004-07-01\"";
  const std::string winter = "path = \"winter.tif\"\ntime = \"2004-01-01\"";
  const std::string inset = "path = \"inset.tif\"", late = inset + "\ntime = \"2004-07-01\"";
  MustBuild(folder, Layer("imagery", {winter, summer}));
  // Without a time it lies under all steps, with one over its own.
  ASSERT_TRUE(Add(folder, Layer("imagery", {inset})).ok());
  ExpectSame(PagesOf(folder), BuiltWhole("update_whole", folder, Layer("imagery", {inset, winter, summer})));
  ASSERT_TRUE(Add(folder, Layer("imagery", {late}) + Layer("elevation", {"path = \"heights.tif\""})).ok());
  ExpectSame(PagesOf(folder), BuiltWhole("update_whole", folder,
                                         Layer("imagery", {inset, winter, summer, late}) +
                                             Layer("elevation", {"path = \"heights.tif\""})));
  const auto other_time = Add(folder, Layer("imagery", {inset + "\ntime = \"2004-04-01\""}));
  ASSERT_FALSE(other_time.ok());
  EXPECT_NE(other_time.message().find("build the dataset again"), std::string::npos) << other_time.message();
}

TEST(Update, WhatCannotBeDoneIsSaidAndChangesNothing) {
  const std::string folder = FreshFolder("update_refused");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128));
  Noise(folder + "/cut.tif", 2, 300, 300, Degrees(10, 50, 0.02));
  fs::resize_file(folder + "/cut.tif", fs::file_size(folder + "/cut.tif") / 2);
  Write(folder + "/empty.tif", {.width = 9,
                                .height = 9,
                                .affine = Degrees(10, 50, 0.1),
                                .value = [](int, int, int) { return -1.0; },
                                .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-1); }});
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
  const Pages before = PagesOf(folder);
  const auto refused = [&](const Result<BuildReport>& report, const std::string& part) {
    ASSERT_FALSE(report.ok()) << part;
    EXPECT_NE(report.message().find(part), std::string::npos) << report.message();
    ExpectSame(PagesOf(folder), before);
    EXPECT_FALSE(fs::exists(folder + "/out.partial"));
  };
  refused(Add(folder, Layer("elevation", {"path = \"missing.tif\""})), "missing.tif");
  refused(Add(folder, Layer("elevation", {"path = \"cut.tif\""})), "truncated");
  refused(Add(folder, Layer("elevation", {"path = \"empty.tif\""})), "covers nothing");
  refused(Add(folder, Layer("elevation", {"path = \"world.tif\""})), "already");
  refused(Remove(folder, "world.tif"), "without a source");
  refused(Remove(folder, "other.tif"), "no source");
  refused(Remove(folder, "world.tif", "imagery"), "imagery");
  fs::rename(folder + "/world.tif", folder + "/elsewhere.tif");
  refused(Refresh(folder), "world.tif");
}

TEST(Update, KilledOrOnAFullDiskItLeavesTheDatasetAsItWas) {
  const std::string folder = FreshFolder("update_killed");
  Noise(folder + "/world.tif", 1, 128, 64, Degrees(-180, 90, 360.0 / 128));
  Noise(folder + "/large.tif", 2, 2000, 2000, Degrees(10, 50, 0.01));
  const std::string large = Layer("elevation", {"path = \"large.tif\""});
  ASSERT_TRUE(Succeeds([&] {
    MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
    return Dataset::Open(folder + "/out").ok();
  }));
  const fs::path partial = folder + "/out.partial/data.mdb";
  std::error_code error;
  const auto far_enough = [&] { return fs::exists(partial, error) && fs::file_size(partial, error) > (1 << 21); };
  ASSERT_TRUE(IsKilledWhen(far_enough, [&] { static_cast<void>(Add(folder, large).ok()); }));
  const int status = InChild([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{rlim_t{2} << 20, rlim_t{2} << 20};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
    const auto report = Add(folder, large);
    return !report.ok() && report.message().find("disk is full") != std::string::npos ? 0 : 3;
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_FALSE(fs::exists(folder + "/out.partial"));
  const Pages before = PagesOf(folder);
  EXPECT_EQ(MustOpen(folder)->layers()[0].sources.size(), 1u);
  ASSERT_TRUE(Add(folder, large).ok());
  ASSERT_TRUE(Remove(folder, "large.tif").ok());
  ExpectSame(PagesOf(folder), before);
}

}  // namespace
}  // namespace belvedere

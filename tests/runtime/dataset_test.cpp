#include "runtime/paging/dataset.h"

#include "runtime/base/iso_time.h"
#include "runtime/paging/dataset_store.h"
#include "runtime/paging/dataset_writer.h"
#include "runtime/paging/page_codec.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

namespace belvedere {
namespace {

namespace fs = std::filesystem;

std::string FreshFolder(const std::string& name) {
  const std::string path = testing::TempDir() + "/belvedere_dataset_test_" + name;
  fs::remove_all(path);
  return path;
}

ElevationPage Slope(Quadcode node) {
  ElevationPage page;
  page.max_m = 1;
  for (int row = 0; row < kElevationSide; ++row) {
    for (int column = 0; column < kElevationSide; ++column) {
      page.heights_mm.push_back(1000 * column + 7 * row + static_cast<int32_t>(node.word() % 1000));
    }
  }
  return page;
}

LayerRecord Layer(const std::string& name, LayerKind kind) {
  LayerRecord layer;
  layer.name = name;
  layer.kind = kind;
  layer.sources.push_back({"a.tif", "EPSG:4326", {-180, -90, 180, 90}, -9999.0, "egm96", 1});
  return layer;
}

// All roots, and the four children of tree 12's, of an elevation layer.
std::string MakeDataset(const std::string& name) {
  const std::string path = FreshFolder(name);
  auto writer = DatasetWriter::Create(path);
  EXPECT_TRUE(writer.ok()) << writer.message();
  for (int tree = 0; tree < kTrees; ++tree) {
    EXPECT_TRUE((*writer)->Put(0, Quadcode::Root(tree), EncodeElevation(Slope(Quadcode::Root(tree)))).ok());
  }
  for (int which = 0; which < 4; ++which) {
    const Quadcode node = Quadcode::Root(12).Child(which);
    EXPECT_TRUE((*writer)->Put(0, node, EncodeElevation(Slope(node))).ok());
  }
  EXPECT_TRUE((*writer)->Commit().ok());
  EXPECT_TRUE((*writer)->Get(0, Quadcode::Root(3)).has_value());
  EXPECT_TRUE((*writer)->Finish({Layer("elevation", LayerKind::kElevation)}, "2026-01-02T03:04:05Z").ok());
  return path;
}

TEST(Dataset, WhatIsWrittenIsRead) {
  const auto dataset = Dataset::Open(MakeDataset("read"));
  ASSERT_TRUE(dataset.ok()) << dataset.message();
  EXPECT_EQ((*dataset)->build_time(), "2026-01-02T03:04:05Z");
  ASSERT_EQ((*dataset)->layers().size(), 1u);
  const LayerRecord& layer = (*dataset)->layers()[0];
  EXPECT_EQ(layer.name, "elevation");
  EXPECT_EQ(layer.pages, 36);
  EXPECT_EQ(layer.pages_per_level, (std::vector<int64_t>{32, 4}));
  EXPECT_EQ(layer.max_level, 1);
  EXPECT_EQ(layer.sources.at(0).nodata, -9999.0);
  const Quadcode child = Quadcode::Root(12).Child(2);
  const auto page = (*dataset)->ReadElevation(0, child);
  ASSERT_TRUE(page.ok()) << page.message();
  EXPECT_EQ((*page)->heights_mm, Slope(child).heights_mm);
}

TEST(Dataset, KnowsWhichQuadnodesExist) {
  const auto dataset = Dataset::Open(MakeDataset("exists"));
  ASSERT_TRUE(dataset.ok()) << dataset.message();
  const Quadcode root = Quadcode::Root(12);
  EXPECT_TRUE((*dataset)->Exists(0, root));
  EXPECT_TRUE((*dataset)->HasChildren(0, root));
  EXPECT_FALSE((*dataset)->HasChildren(0, Quadcode::Root(11)));
  EXPECT_FALSE((*dataset)->Exists(0, root.Child(0).Child(0)));
  EXPECT_EQ((*dataset)->Nodes(0).size(), 36u);
  EXPECT_TRUE(std::is_sorted((*dataset)->Nodes(0).begin(), (*dataset)->Nodes(0).end()));
  const GeoBox box = root.Box();
  EXPECT_EQ((*dataset)->FinestContaining(0, box.south_deg + 1, box.west_deg + 1), root.Child(0));
  EXPECT_EQ((*dataset)->FinestContaining(0, box.south_deg + 1, box.west_deg + 1, 0), root);
  const auto missing = (*dataset)->ReadElevation(0, root.Child(0).Child(0));
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.message().find("12:00"), std::string::npos) << missing.message();
}

TEST(Dataset, ManyThreadsReadAtOnce) {
  const auto dataset = Dataset::Open(MakeDataset("threads"));
  ASSERT_TRUE(dataset.ok()) << dataset.message();
  std::vector<std::thread> threads;
  std::atomic<int> good{0};
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int tree = 0; tree < kTrees; ++tree) {
        const auto page = (*dataset)->ReadElevation(0, Quadcode::Root(tree));
        if (page.ok() && (*page)->heights_mm == Slope(Quadcode::Root(tree)).heights_mm) ++good;
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(good.load(), 8 * kTrees);
}

TEST(Dataset, ADamagedPageIsNamed) {
  const std::string path = MakeDataset("damaged");
  const Quadcode node = Quadcode::Root(7);
  const auto value = EncodeElevation(Slope(node));
  std::fstream file(path + "/data.mdb", std::ios::in | std::ios::out | std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  file.clear();
  int copies = 0;  // the store may hold older ones
  const std::string wanted(value.begin(), value.end());
  for (size_t at = bytes.find(wanted); at != std::string::npos; at = bytes.find(wanted, at + 1), ++copies) {
    file.seekp(static_cast<std::streamoff>(at + value.size() / 2));
    file.put(static_cast<char>(bytes[at + value.size() / 2] ^ 0x55));
  }
  ASSERT_GT(copies, 0);
  file.close();
  const auto dataset = Dataset::Open(path);
  ASSERT_TRUE(dataset.ok()) << dataset.message();
  const auto page = (*dataset)->ReadElevation(0, node);
  ASSERT_FALSE(page.ok());
  for (const char* part : {path.c_str(), "elevation", "7:", "checksum"}) {
    EXPECT_NE(page.message().find(part), std::string::npos) << page.message();
  }
  EXPECT_TRUE((*dataset)->ReadElevation(0, Quadcode::Root(8)).ok());
}

TEST(Dataset, MissingCutAndForeignStoresAreRefused) {
  const auto nothing = Dataset::Open(FreshFolder("nothing"));
  ASSERT_FALSE(nothing.ok());
  EXPECT_NE(nothing.message().find("belvedere-build"), std::string::npos);
  const std::string cut = MakeDataset("cut");
  fs::resize_file(cut + "/data.mdb", fs::file_size(cut + "/data.mdb") / 2);
  EXPECT_FALSE(Dataset::Open(cut).ok());
  const std::string foreign = FreshFolder("foreign");
  fs::create_directories(foreign);
  std::ofstream(foreign + "/data.mdb") << std::string(20000, 'x');
  EXPECT_FALSE(Dataset::Open(foreign).ok());
}

TEST(Dataset, AnotherVersionIsRefusedByName) {
  store::Metadata metadata{"2026-01-02T03:04:05Z", {Layer("elevation", LayerKind::kElevation)}};
  metadata.layers[0].pages_per_level = {32};
  std::string text = store::ToJson(metadata);
  ASSERT_TRUE(store::FromJson(text).ok()) << store::FromJson(text).message();
  const std::string own = fmt::format("\"version\": {}", kDatasetVersion);
  ASSERT_NE(text.find(own), std::string::npos);
  std::string older = text;
  older.replace(older.find(own), own.size(), fmt::format("\"version\": {}", kOldestDatasetVersion));
  const auto read = store::FromJson(older);
  ASSERT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(read->version, kOldestDatasetVersion);
  EXPECT_EQ(store::FromJson(text)->version, kDatasetVersion);
  text.replace(text.find(own), own.size(), "\"version\": 77");
  const auto refused = store::FromJson(text);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.message().find("77"), std::string::npos) << refused.message();
  EXPECT_FALSE(store::FromJson("{").ok());
  EXPECT_FALSE(store::FromJson("{}").ok());
}

TEST(Dataset, KeysSortByLayerThenQuadcode) {
  EXPECT_EQ(store::MakeKey(2, 0x0102030405060708u), (store::Key{2, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_LT(store::MakeKey(0, ~uint64_t{0}), store::MakeKey(1, 0));
  EXPECT_EQ(store::WordOfKey(store::MakeKey(5, 0xFEDCBA9876543210u).data()), 0xFEDCBA9876543210u);
}

TEST(Dataset, AnUnfinishedBuildLeavesThePreviousOne) {
  const std::string path = MakeDataset("previous");
  {
    auto writer = DatasetWriter::Create(path);
    ASSERT_TRUE(writer.ok()) << writer.message();
    ASSERT_TRUE((*writer)->Put(0, Quadcode::Root(0), EncodeElevation(Slope(Quadcode::Root(5)))).ok());
    ASSERT_TRUE((*writer)->Commit().ok());
  }
  EXPECT_FALSE(fs::exists(path + ".partial"));
  const auto dataset = Dataset::Open(path);
  ASSERT_TRUE(dataset.ok()) << dataset.message();
  EXPECT_EQ((*dataset)->layers()[0].pages, 36);
}

// Leaves what a writer that is killed after a commit would, and something that it had not committed.
std::string LeaveUnfinished(const std::string& name, const std::string& made_of) {
  const std::string path = FreshFolder(name);
  fs::remove_all(path + ".partial");
  {
    auto writer = DatasetWriter::Create(path, made_of);
    EXPECT_TRUE(writer.ok()) << writer.message();
    EXPECT_TRUE((*writer)->Put(1, Quadcode::Root(3), {1, 2, 3}).ok());
    EXPECT_TRUE((*writer)->PutDeviations(1, Quadcode::Root(3), {4, 5}).ok());
    EXPECT_TRUE((*writer)->Note("so far").ok());
    EXPECT_TRUE((*writer)->Commit().ok());
    EXPECT_TRUE((*writer)->Put(1, Quadcode::Root(4), {6}).ok());
    fs::copy(path + ".partial", path + ".kept", fs::copy_options::recursive);
  }
  fs::rename(path + ".kept", path + ".partial");
  return path;
}

TEST(Dataset, WhatAKilledWriterCommittedIsTakenUp) {
  const std::string path = LeaveUnfinished("resumed", "these sources");
  auto writer = DatasetWriter::Create(path, "these sources");
  ASSERT_TRUE(writer.ok()) << writer.message();
  EXPECT_EQ((*writer)->Resumed(1), (std::vector<uint64_t>{Quadcode::Root(3).word()}));
  EXPECT_TRUE((*writer)->Resumed(0).empty());
  EXPECT_EQ((*writer)->notes(), "so far");
  EXPECT_EQ((*writer)->Get(1, Quadcode::Root(3)), (std::vector<uint8_t>{1, 2, 3}));
  EXPECT_EQ((*writer)->GetDeviations(1, Quadcode::Root(3)), (std::vector<uint8_t>{4, 5}));
  EXPECT_FALSE((*writer)->Get(1, Quadcode::Root(4)));
  ASSERT_TRUE((*writer)->Finish({Layer("a", LayerKind::kImagery), Layer("b", LayerKind::kImagery)}, "now").ok());
  const auto dataset = Dataset::Open(path);
  ASSERT_TRUE(dataset.ok()) << dataset.message();
  EXPECT_EQ((*dataset)->Nodes(1).size(), 1u) << "deviations are no page";
  EXPECT_EQ((*dataset)->layers()[1].bytes, 3);
  EXPECT_EQ((*dataset)->ReadDeviations(1, Quadcode::Root(3)), (std::vector<uint8_t>{4, 5}));
}

TEST(Dataset, WhatIsMadeOfSomethingElseIsThrownAway) {
  for (const std::string made_of : {"other sources", ""}) {
    const std::string path = LeaveUnfinished("not_resumed", "these sources");
    auto writer = DatasetWriter::Create(path, made_of);
    ASSERT_TRUE(writer.ok()) << writer.message();
    EXPECT_TRUE((*writer)->Resumed(1).empty());
    EXPECT_EQ((*writer)->notes(), "");
    EXPECT_FALSE((*writer)->Get(1, Quadcode::Root(3)));
  }
  const std::string path = LeaveUnfinished("discarded", "these sources");
  EXPECT_TRUE(DatasetWriter::Discard(path).ok());
  EXPECT_FALSE(fs::exists(path + ".partial"));
  EXPECT_TRUE(DatasetWriter::Discard(path).ok());
}

TEST(Dataset, ADamagedUnfinishedStoreIsThrownAway) {
  const std::string path = LeaveUnfinished("torn", "these sources");
  fs::resize_file(path + ".partial/data.mdb", 100);
  auto writer = DatasetWriter::Create(path, "these sources");
  ASSERT_TRUE(writer.ok()) << writer.message();
  EXPECT_TRUE((*writer)->Resumed(1).empty());
  EXPECT_TRUE((*writer)->Put(1, Quadcode::Root(4), {6}).ok());
}

TEST(Dataset, OneWriterAtATime) {
  const std::string path = FreshFolder("two_writers");
  auto first = DatasetWriter::Create(path);
  ASSERT_TRUE(first.ok());
  const auto second = DatasetWriter::Create(path);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.message().find("another build"), std::string::npos) << second.message();
  EXPECT_FALSE(DatasetWriter::Discard(path).ok());
  EXPECT_TRUE((*first)->Put(0, Quadcode::Root(0), {1}).ok());
  EXPECT_TRUE((*first)->Finish({Layer("a", LayerKind::kImagery)}, "now").ok());
  EXPECT_TRUE(DatasetWriter::Create(path).ok());
}

TEST(Dataset, AnOpenDatasetOutlivesItsReplacement) {
  const std::string path = MakeDataset("replaced");
  const auto before = Dataset::Open(path);
  ASSERT_TRUE(before.ok());
  auto writer = DatasetWriter::Create(path);
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE((*writer)->Put(0, Quadcode::Root(0), EncodeElevation(Slope(Quadcode::Root(0)))).ok());
  ASSERT_TRUE((*writer)->Finish({Layer("new", LayerKind::kElevation)}, "2026-02-02T00:00:00Z").ok());
  EXPECT_TRUE((*before)->ReadElevation(0, Quadcode::Root(31)).ok());
  const auto after = Dataset::Open(path);
  ASSERT_TRUE(after.ok());
  EXPECT_EQ((*after)->layers()[0].name, "new");
  EXPECT_FALSE((*after)->Exists(0, Quadcode::Root(31)));
}

TEST(Dataset, BilinearHeightIsThatOfThePosts) {
  const Quadcode node = Quadcode::Root(12).Child(1);
  const ElevationPage page = Slope(node);
  const GeoBox box = node.Box();
  const double cell = node.HeightDegrees() / kCells;
  EXPECT_NEAR(BilinearHeight(page, node, box.south_deg, box.west_deg), page.at(0, 0) / 1000.0, 1e-9);
  EXPECT_NEAR(BilinearHeight(page, node, box.north_deg, box.east_deg), page.at(kCells, kCells) / 1000.0, 1e-9);
  const double middle = (page.at(4, 9) + page.at(5, 9) + page.at(4, 10) + page.at(5, 10)) / 4000.0;
  EXPECT_NEAR(BilinearHeight(page, node, box.south_deg + 9.5 * cell, box.west_deg + 4.5 * cell + 360), middle, 1e-9);
}

TEST(Dataset, StepsOfALayerAreKept) {
  store::Metadata metadata;
  metadata.build_time = "2026-01-02T03:04:05Z";
  for (const char* time : {"2004-01-01T00:00:00Z", "2004-07-01T12:30:00Z"}) {
    LayerRecord layer = Layer("seasons@" + std::string(time), LayerKind::kImagery);
    layer.step = StepOf{"seasons", *ParseIsoTime(time), Repeats::kEveryYear};
    layer.sources[0].utc_s = layer.step->utc_s;
    metadata.layers.push_back(layer);
  }
  metadata.layers.push_back(Layer("elevation", LayerKind::kElevation));
  const auto read = store::FromJson(store::ToJson(metadata));
  ASSERT_TRUE(read.ok()) << read.message();
  ASSERT_TRUE(read->layers[1].step);
  EXPECT_EQ(read->layers[1].step->layer, "seasons");
  EXPECT_EQ(read->layers[1].step->utc_s, *ParseIsoTime("2004-07-01T12:30:00Z"));
  EXPECT_EQ(read->layers[1].step->repeats, Repeats::kEveryYear);
  EXPECT_EQ(read->layers[1].sources[0].utc_s, read->layers[1].step->utc_s);
  EXPECT_FALSE(read->layers[2].step);
  EXPECT_FALSE(read->layers[2].sources[0].utc_s);
}

TEST(Dataset, MetadataOfALayerThatDoesNotChangeAreAsTheyWere) {
  const std::string text = store::ToJson({"2026-01-02T03:04:05Z", {Layer("imagery", LayerKind::kImagery)}});
  EXPECT_EQ(text.find("step_of"), std::string::npos);
  EXPECT_EQ(text.find("\"time\""), std::string::npos);
}

TEST(Dataset, AStepOfNoTimeIsDamage) {
  LayerRecord layer = Layer("seasons@2004-01-01T00:00:00Z", LayerKind::kImagery);
  layer.step = StepOf{"seasons", *ParseIsoTime("2004-01-01"), Repeats::kEveryYear};
  const std::string good = store::ToJson({"2026-01-02T03:04:05Z", {layer}});
  for (const auto& [from, to] :
       {std::pair{"\"2004-01-01T00:00:00Z\"", "\"winter\""}, std::pair{"\"year\"", "\"day\""}}) {
    std::string bad = good;
    bad.replace(bad.find(from), std::string(from).size(), to);
    const auto read = store::FromJson(bad);
    ASSERT_FALSE(read.ok());
    EXPECT_NE(read.message().find("damaged"), std::string::npos) << read.message();
  }
}

}  // namespace
}  // namespace belvedere

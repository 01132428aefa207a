#include "runtime/paging/change_writer.h"

#include "runtime/paging/dataset_store.h"
#include "runtime/paging/store_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace belvedere {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<uint8_t>;

std::vector<LayerRecord> Layers() {
  LayerRecord layer;
  layer.name = "imagery";
  layer.kind = LayerKind::kImagery;
  return {layer};
}

// The roots of all trees, each of its number, and deviations of some.
std::string MakeDataset(const std::string& name) {
  const std::string path = testing::TempDir() + "/belvedere_change_writer_" + name;
  fs::remove_all(path);
  auto writer = DatasetWriter::Create(path);
  EXPECT_TRUE(writer.ok()) << writer.message();
  for (int tree = 0; tree < kTrees; ++tree)
    EXPECT_TRUE((*writer)->Put(0, Quadcode::Root(tree), {static_cast<uint8_t>(tree)}).ok());
  EXPECT_TRUE((*writer)->PutDeviations(0, Quadcode::Root(5), {55}).ok());
  EXPECT_TRUE((*writer)->PutDeviations(0, Quadcode::Root(6), {66}).ok());
  EXPECT_TRUE((*writer)->Finish(Layers(), "first").ok());
  return path;
}

std::unique_ptr<Dataset> MustOpen(const std::string& path) {
  auto dataset = Dataset::Open(path);
  EXPECT_TRUE(dataset.ok()) << dataset.message();
  return dataset.ok() ? std::move(*dataset) : nullptr;
}

std::unique_ptr<ChangeWriter> MustChange(const std::string& path) {
  auto writer = ChangeWriter::Create(path);
  EXPECT_TRUE(writer.ok()) << writer.message();
  return writer.ok() ? std::move(*writer) : nullptr;
}

TEST(ChangeWriter, PagesChangeComeAndGo) {
  const std::string path = MakeDataset("change");
  const auto before = MustOpen(path);
  const Quadcode child = Quadcode::Root(3).Child(2);
  {
    const auto writer = MustChange(path);
    EXPECT_TRUE(writer->Put(0, Quadcode::Root(3), {33, 3}).ok());
    EXPECT_TRUE(writer->Put(0, Quadcode::Root(4), {4}).ok());  // as it was
    EXPECT_TRUE(writer->Put(0, child, {1, 2, 3}).ok());
    EXPECT_TRUE(writer->PutDeviations(0, Quadcode::Root(5), {55}).ok());  // as they were
    EXPECT_TRUE(writer->Put(0, Quadcode::Root(5), {50}).ok());
    EXPECT_TRUE(writer->Put(0, Quadcode::Root(6), {6}).ok());  // has no deviations any more
    EXPECT_TRUE(writer->Remove(0, Quadcode::Root(7)).ok());
    EXPECT_EQ(writer->written(), 3);
    EXPECT_EQ(writer->removed(), 1);
    EXPECT_TRUE(writer->WasPut(0, Quadcode::Root(4)));
    EXPECT_FALSE(writer->WasPut(0, Quadcode::Root(8)));
    EXPECT_TRUE(MustOpen(path)->Exists(0, Quadcode::Root(7))) << "nothing is changed before it is finished";
    EXPECT_TRUE(writer->Finish(Layers(), "second").ok());
  }
  const auto after = MustOpen(path);
  EXPECT_EQ(after->build_time(), "second");
  EXPECT_EQ(after->ReadRaw(0, Quadcode::Root(3)), (Bytes{33, 3}));
  EXPECT_EQ(after->StoredBytes(0, Quadcode::Root(3)), 2);
  EXPECT_EQ(after->ReadRaw(0, Quadcode::Root(4)), Bytes{4});
  EXPECT_EQ(after->ReadRaw(0, child), (Bytes{1, 2, 3}));
  EXPECT_TRUE(after->Exists(0, child));
  EXPECT_EQ(after->ReadDeviations(0, Quadcode::Root(5)), Bytes{55});
  EXPECT_FALSE(after->ReadDeviations(0, Quadcode::Root(6)));
  EXPECT_FALSE(after->Exists(0, Quadcode::Root(7)));
  EXPECT_FALSE(after->ReadRaw(0, Quadcode::Root(7)));
  EXPECT_EQ(after->layers()[0].pages, kTrees);
  EXPECT_EQ(after->layers()[0].pages_per_level, (std::vector<int64_t>{kTrees - 1, 1}));
  EXPECT_EQ(after->layers()[0].bytes, kTrees - 1 + 1 + 3);
  EXPECT_TRUE(std::is_sorted(after->Nodes(0).begin(), after->Nodes(0).end()));
  // Whoever had it open goes on with what it opened.
  EXPECT_EQ(before->ReadRaw(0, Quadcode::Root(3)), Bytes{3});
  EXPECT_TRUE(before->Exists(0, Quadcode::Root(7)));
  EXPECT_FALSE(before->Exists(0, child));
}

// Random changes, more than a dataset keeps apart, beside a map that has them too.
TEST(ChangeWriter, ManyChangesAreOneAfterTheOther) {
  const std::string path = MakeDataset("many");
  std::mt19937 random(7);
  std::map<uint64_t, Bytes> wanted;
  for (int tree = 0; tree < kTrees; ++tree) wanted[Quadcode::Root(tree).word()] = {static_cast<uint8_t>(tree)};
  for (int change = 0; change < 3 * StoreStack::kMostChanges; ++change) {
    const auto writer = MustChange(path);
    for (int i = 0; i < 6; ++i) {
      const Quadcode root = Quadcode::Root(static_cast<int>(random() % kTrees));
      const std::span<const int> children = root.Children();
      const Quadcode node = random() % 2 == 0 ? root : root.Child(children[random() % children.size()]);
      if (writer->WasPut(0, node)) continue;
      if (wanted.contains(node.word()) && random() % 3 == 0) {
        EXPECT_TRUE(writer->Remove(0, node).ok());
        wanted.erase(node.word());
        break;
      }
      const Bytes value(1 + random() % 9, static_cast<uint8_t>(random()));
      EXPECT_TRUE(writer->Put(0, node, value).ok());
      wanted[node.word()] = value;
    }
    EXPECT_TRUE(writer->Finish(Layers(), std::to_string(change)).ok());
    const auto dataset = MustOpen(path);
    ASSERT_EQ(dataset->Nodes(0).size(), wanted.size()) << change;
    int64_t bytes = 0;
    for (const auto& [word, value] : wanted) {
      EXPECT_EQ(dataset->ReadRaw(0, *Quadcode::FromWord(word)), value) << change;
      bytes += static_cast<int64_t>(value.size());
    }
    EXPECT_EQ(dataset->layers()[0].bytes, bytes);
    const auto stack = StoreStack::Open(path);
    ASSERT_TRUE(stack.ok());
    EXPECT_EQ((*stack)->changes(), change % StoreStack::kMostChanges + 1);
    EXPECT_FALSE(fs::exists(path + "/" + store::ChangeFile((*stack)->changes() + 1))) << "what is taken in is removed";
  }
}

// Where a build that replaces the dataset is killed before it has removed the changes of the one before.
TEST(ChangeWriter, ChangesOfAnotherDatasetAreNotLookedAt) {
  const std::string path = MakeDataset("stale");
  {
    const auto writer = MustChange(path);
    EXPECT_TRUE(writer->Put(0, Quadcode::Root(3), {33}).ok());
    EXPECT_TRUE(writer->Finish(Layers(), "second").ok());
  }
  fs::copy(path + "/change-1.mdb", path + ".kept", fs::copy_options::overwrite_existing);
  MakeDataset("stale");
  EXPECT_FALSE(fs::exists(path + "/change-1.mdb")) << "a build removes them";
  fs::rename(path + ".kept", path + "/change-1.mdb");
  EXPECT_EQ(MustOpen(path)->ReadRaw(0, Quadcode::Root(3)), Bytes{3});
  // The next change takes its place.
  const auto writer = MustChange(path);
  EXPECT_TRUE(writer->Put(0, Quadcode::Root(3), {34}).ok());
  EXPECT_TRUE(writer->Finish(Layers(), "third").ok());
  EXPECT_EQ(MustOpen(path)->ReadRaw(0, Quadcode::Root(3)), Bytes{34});
}

// Changes that are taken in by a ninth leave, between two steps of the writer, a stack that is older than the one
// before.
TEST(ChangeWriter, WhoOpensMeanwhileNeverGoesBack) {
  const std::string path = MakeDataset("meanwhile");
  constexpr uint8_t kChanges = 100;
  const auto write = [&path](uint8_t value) {
    const auto writer = MustChange(path);
    EXPECT_TRUE(writer->Put(0, Quadcode::Root(0), {value}).ok());
    EXPECT_TRUE(writer->Finish(Layers(), "later").ok());
  };
  write(1);
  std::thread writer([&write] {
    for (uint8_t value = 2; value <= kChanges; ++value) write(value);
  });
  uint8_t seen = 0;
  while (seen < kChanges) {
    const auto dataset = Dataset::Open(path);
    const auto bytes = dataset.ok() ? (*dataset)->ReadRaw(0, Quadcode::Root(0)) : std::nullopt;
    EXPECT_TRUE(bytes) << dataset.message();
    if (!bytes) break;
    EXPECT_GE(bytes->front(), seen);
    seen = std::max(seen, bytes->front());
  }
  writer.join();
}

TEST(ChangeWriter, ADamagedChangeIsNotPassedOver) {
  const std::string path = MakeDataset("damaged");
  {
    const auto writer = MustChange(path);
    EXPECT_TRUE(writer->Put(0, Quadcode::Root(3), {33}).ok());
    EXPECT_TRUE(writer->Finish(Layers(), "second").ok());
  }
  fs::resize_file(path + "/change-1.mdb", 5000);
  EXPECT_FALSE(Dataset::Open(path).ok());
}

TEST(ChangeWriter, OneAtATimeAndNoneWithoutADataset) {
  const std::string path = MakeDataset("locked");
  {
    const auto first = MustChange(path);
    EXPECT_FALSE(ChangeWriter::Create(path).ok());
    EXPECT_FALSE(DatasetWriter::Create(path).ok());
  }
  EXPECT_TRUE(ChangeWriter::Create(path).ok());
  EXPECT_FALSE(ChangeWriter::Create(path + "_nothing").ok());
  EXPECT_FALSE(fs::exists(path + "_nothing.partial"));
}

}  // namespace
}  // namespace belvedere

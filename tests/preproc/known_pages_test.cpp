#include "preproc/known_pages.h"

#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;

// A made dataset's pages, and deviations of those that the test gives some.
class DatasetPages final : public KnownPages {
 public:
  explicit DatasetPages(const Dataset& dataset) : dataset_(dataset) {}
  bool Knows(int layer, Quadcode node) const override { return dataset_.Exists(layer, node); }
  bool Exists(int layer, Quadcode node) const override { return dataset_.Exists(layer, node); }
  std::optional<std::vector<uint8_t>> Page(int layer, Quadcode node) const override {
    auto page = dataset_.ReadRaw(layer, node);
    if (page && node == damaged) (*page)[page->size() / 2] ^= 1;
    return page;
  }
  std::optional<std::vector<uint8_t>> Deviations(int layer, Quadcode node) const override {
    ++asked;
    if (!with_deviations) return std::nullopt;
    return dataset_.ReadDeviations(layer, node);
  }

  bool with_deviations = true;
  Quadcode damaged = Quadcode::Root(0);
  mutable int asked = 0;

 private:
  const Dataset& dataset_;
};

// Terrain of four levels in one place.
std::unique_ptr<Dataset> MakeDataset(const std::string& name) {
  const std::string folder = FreshFolder(name);
  std::mt19937 random(5);
  Write(folder + "/fine.tif",
        {.width = 80, .height = 80, .affine = Degrees(10, 20, 0.022), .value = [&](int, int, int) {
           return static_cast<double>(random() % 3000);
         }});
  MustBuild(folder, Layer("elevation", {"path = \"fine.tif\""}));
  return MustOpen(folder);
}

TEST(KnownPages, StoredDeviationsAreThoseOfThePagesUnder) {
  const auto dataset = MakeDataset("known");
  ASSERT_GE(dataset->MaxLevel(0), kDepthWithDeviations + 1);
  DatasetPages pages(*dataset);
  const Quadcode root = Quadcode::Containing(19, 11, 0);
  const auto stored = ReadBounded(pages, 0, root);
  ASSERT_TRUE(stored.ok()) << stored.message();
  EXPECT_EQ(pages.asked, 1) << "nothing under it need be read";
  EXPECT_EQ(stored->depth, kDepthWithDeviations);
  pages.with_deviations = false;
  const auto found = ReadBounded(pages, 0, root);
  ASSERT_TRUE(found.ok()) << found.message();
  EXPECT_EQ(found->depth, dataset->MaxLevel(0));
  EXPECT_EQ(found->page->heights_mm, stored->page->heights_mm);
  int different = 0, not_zero = 0;
  for (size_t cell = 0; cell < found->deviations.size(); ++cell) {
    different += found->deviations[cell].low != stored->deviations[cell].low ||
                 found->deviations[cell].high != stored->deviations[cell].high;
    not_zero += found->deviations[cell].low != 0;
  }
  EXPECT_EQ(different, 0);
  EXPECT_GT(not_zero, 0);
}

TEST(KnownPages, DeviationsAreStoredWhereManyPagesLieUnder) {
  const auto dataset = MakeDataset("stored");
  Quadcode node = Quadcode::Containing(19.9, 10.1, 0);
  for (int depth = dataset->MaxLevel(0); depth >= 0; --depth) {
    EXPECT_EQ(dataset->ReadDeviations(0, node).has_value(), depth >= kDepthWithDeviations) << depth;
    if (depth > 0) node = Quadcode::Containing(19.9, 10.1, node.level() + 1);
  }
}

TEST(KnownPages, ADamagedPageIsNamed) {
  const auto dataset = MakeDataset("damaged_known");
  DatasetPages pages(*dataset);
  pages.with_deviations = false;
  pages.damaged = Quadcode::Containing(19, 11, 2);
  const auto bounded = ReadBounded(pages, 0, Quadcode::Containing(19, 11, 0));
  ASSERT_FALSE(bounded.ok());
  EXPECT_NE(bounded.message().find(pages.damaged.ToString()), std::string::npos) << bounded.message();
}

}  // namespace
}  // namespace belvedere

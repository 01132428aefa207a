#include "managers/list_pages.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <tuple>

namespace belvedere {
namespace {

constexpr DataType kTerrain = 0;
constexpr DataType kImagery = 1;
constexpr DataType kModels = 2;
constexpr ViewId kView = 7;

LayerTable ThreeLayers() {
  LayerTable layers;
  const auto all = [](Quadcode) { return true; };
  layers.Add({"terrain", PageKind::kTerrain, 0, 5, all});
  layers.Add({"imagery", PageKind::kColour, 0, 5, all});
  layers.Add({"model", PageKind::kModel, 0, kMaxLevel, all});
  return layers;
}

class ListPagesTest : public testing::Test {
 protected:
  PagePin PutImage(Quadcode node) { return paging_.cache.Insert({kImagery, node}, std::make_unique<ImagePage>()); }

  ManualClock clock_;
  Paging paging_{ThreeLayers(), size_t{1} << 24, clock_};
  DisplayList list_;
  const Quadcode node_ = Quadcode::Root(3).Child(1);
};

TEST_F(ListPagesTest, WhatIsNotInMemoryBecomesAWish) {
  ListPages pages(paging_, kTerrain, list_);
  EXPECT_EQ(pages.Terrain(node_), nullptr);
  EXPECT_TRUE(pages.Want({kTerrain, node_}, 5));
  EXPECT_TRUE(pages.Want({kTerrain, node_}, 5)) << "wanting twice is one wish";
  EXPECT_EQ(pages.pages_waiting(), 1U);
  pages.Finish(kView, ListPages::Queues::kTerrain);
  EXPECT_EQ(paging_.queue(kTerrain).TryTake(), (PageKey{kTerrain, node_}));
  EXPECT_TRUE(list_.uploads.empty());
}

TEST_F(ListPagesTest, TerrainInMemoryIsDrawnFromThere) {
  auto page = std::make_unique<TerrainPage>();
  const TerrainPage* made = page.get();
  paging_.cache.Insert({kTerrain, node_}, std::move(page));
  ListPages pages(paging_, kTerrain, list_);
  EXPECT_EQ(pages.Terrain(node_), made);
  pages.Finish(kView, ListPages::Queues::kTerrain);
  EXPECT_TRUE(list_.uploads.empty());
  EXPECT_GT(paging_.cache.PinnedBytes(), 0U);
}

TEST_F(ListPagesTest, WhatIsInMemoryButNotOnTheGpuBecomesAnUpload) {
  PutImage(node_);
  ListPages pages(paging_, kTerrain, list_);
  EXPECT_EQ(pages.Slot({kImagery, node_}), std::nullopt);
  EXPECT_TRUE(pages.Want({kImagery, node_}, 5));
  pages.Finish(kView, ListPages::Queues::kTerrain);
  ASSERT_EQ(list_.uploads.size(), 1U);
  EXPECT_EQ(list_.uploads[0].key().node, node_);
  EXPECT_EQ(paging_.queue(kImagery).TryTake(), std::nullopt);
}

TEST_F(ListPagesTest, UploadsComeMostWantedFirst) {
  for (int which = 0; which < 4; ++which) PutImage(Quadcode::Root(which));
  ListPages pages(paging_, kTerrain, list_);
  for (const int which : {2, 0, 3, 1}) pages.Want({kImagery, Quadcode::Root(which)}, static_cast<float>(which));
  pages.Finish(kView, ListPages::Queues::kTerrain);
  ASSERT_EQ(list_.uploads.size(), 4U);
  for (int place = 0; place < 4; ++place) {
    EXPECT_EQ(list_.uploads[static_cast<size_t>(place)].key().node, Quadcode::Root(3 - place));
  }
}

TEST_F(ListPagesTest, WhatItHandsOutStaysUntilTheListIsCleared) {
  const Residency* residency = nullptr;
  {
    const PagePin pin = PutImage(node_);
    residency = pin.page().residency().get();
    pin.page().residency()->Place(11);
  }
  {
    ListPages pages(paging_, kTerrain, list_);
    EXPECT_EQ(pages.Slot({kImagery, node_}), 11);
  }
  EXPECT_GT(paging_.cache.PinnedBytes(), 0U);
  EXPECT_FALSE(const_cast<Residency*>(residency)->TryEvict());
  list_.Clear();
  EXPECT_TRUE(const_cast<Residency*>(residency)->TryEvict());
  EXPECT_EQ(paging_.cache.PinnedBytes(), 0U);
}

// Otherwise a view would wait for ever for images that find no place.
TEST_F(ListPagesTest, NoMoreImagesAreWantedThanFit) {
  const auto image = [&](int which) { return PageKey{kImagery, node_.Child(which)}; };
  PutImage(image(0).node).page().residency()->Place(1);
  PutImage(image(1).node);
  ListPages pages(paging_, kTerrain, list_, {.colour = 3});
  EXPECT_TRUE(pages.Slot(image(0)));     // one is there,
  EXPECT_TRUE(pages.Want(image(1), 1));  // one waits for its upload,
  EXPECT_TRUE(pages.Want(image(2), 1));  // and one is to be read
  EXPECT_TRUE(pages.Want(image(2), 1));  // as it was
  EXPECT_FALSE(pages.at_limit());
  EXPECT_FALSE(pages.Want(image(3), 1));
  EXPECT_TRUE(pages.at_limit());
  EXPECT_TRUE(pages.Want({kTerrain, node_.Child(3)}, 1)) << "terrain needs no place there";
  EXPECT_EQ(pages.pages_waiting(), 3U);
  EXPECT_TRUE(pages.Want({kImagery, node_.Ancestor(0)}, 1)) << "nor is the ground left bare";
}

TEST_F(ListPagesTest, AFailedPageIsNotWishedForAgain) {
  paging_.cache.MarkFailed({kImagery, node_}, Status::Error("damaged"));
  ListPages pages(paging_, kTerrain, list_);
  EXPECT_FALSE(pages.Want({kImagery, node_}, 5));
  EXPECT_EQ(pages.pages_waiting(), 0U);
}

TEST_F(ListPagesTest, TheListIsToldWhereThePagesOfEachLayerAre) {
  PutImage(Quadcode::Root(0)).page().residency()->Place(1);
  PutImage(Quadcode::Root(1));
  paging_.cache.MarkFailed({kImagery, Quadcode::Root(3)}, Status::Error("damaged"));
  ListPages pages(paging_, kTerrain, list_);
  for (int tree = 0; tree < 4; ++tree) {
    if (!pages.Slot({kImagery, Quadcode::Root(tree)})) pages.Want({kImagery, Quadcode::Root(tree)}, 1);
  }
  pages.Terrain(node_);  // not in memory, and not wanted
  pages.CountByLayer();
  ASSERT_EQ(list_.layer_pages.size(), 2U);
  EXPECT_EQ(list_.layer_pages[0].layer, "terrain");
  EXPECT_EQ(list_.layer_pages[0].asked, 0U);
  const LayerPages& imagery = list_.layer_pages[1];
  EXPECT_EQ(imagery.layer, "imagery");
  EXPECT_EQ(std::tie(imagery.on_gpu, imagery.in_memory, imagery.asked, imagery.failed), std::tuple(1U, 1U, 1U, 1U));
  list_.Clear();
  EXPECT_TRUE(list_.layer_pages.empty());
}

TEST_F(ListPagesTest, EachManagerSpeaksForItsOwnQueues) {
  DisplayList objects_list;
  ListPages terrain(paging_, kTerrain, list_);
  ListPages objects(paging_, kTerrain, objects_list);
  terrain.Want({kImagery, node_}, 1);
  objects.Want({kModels, node_}, 1);
  terrain.Finish(kView, ListPages::Queues::kTerrain);
  objects.Finish(kView, ListPages::Queues::kObjects);
  EXPECT_TRUE(paging_.queue(kImagery).TryTake()) << "the object manager has not withdrawn it";
  EXPECT_TRUE(paging_.queue(kModels).TryTake());
}

}  // namespace
}  // namespace belvedere

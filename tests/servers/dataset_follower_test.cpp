// A station's pages follow the dataset on disk: what has changed is made anew, what has not stays as it is.
#include "servers/dataset_follower.h"

#include "runtime/paging/change_writer.h"
#include "tests/servers/small_dataset.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

namespace belvedere {
namespace {

const Quadcode kChanged = Quadcode::Root(20), kFar = Quadcode::Root(2);

// What a station has between a dataset and its views, without threads.
class House {
 public:
  House() {
    auto live = LiveDataset::Open(small_.path());
    BELVEDERE_CHECK(live.ok());
    live_ = std::move(*live);
    BELVEDERE_CHECK(RegisterStockModules(registry_, *live_, models_, {}).ok());
    paging_ = std::make_unique<Paging>(MakeLayerTable(registry_), size_t{256} << 20, clock_);
    follower_ = std::make_unique<DatasetFollower>(*paging_, *live_, models_, StockOptions{}, clock_, false);
  }

  PagePin Read(const char* layer, Quadcode node) {
    auto page = ReadIntoCache(*paging_, registry_, Key(layer, node));
    EXPECT_TRUE(page.ok()) << page.message();
    return page.ok() ? std::move(*page) : PagePin();
  }
  PageKey Key(const char* layer, Quadcode node) const { return {paging_->layers.Find(layer)->type, node}; }
  bool Exists(const char* layer, Quadcode node) const { return paging_->layers.Find(layer)->exists(node); }

  // Raises the ground of a quadnode of the elevation, and gives it children where it has none.
  void Raise(Quadcode node, double by_m) {
    auto writer = ChangeWriter::Create(small_.path());
    BELVEDERE_CHECK(writer.ok());
    const auto put = [&](Quadcode at) {
      const auto page = MakeElevation(at, [by_m](GridPoint point) { return WavyHeight(point) + by_m; });
      BELVEDERE_CHECK((*writer)->Put(0, at, EncodeElevation(*page)).ok());
    };
    put(node);
    for (int child = 0; child < 4; ++child) put(node.Child(child));
    BELVEDERE_CHECK((*writer)->Finish((*small_).layers(), "2026-02-02T00:00:00Z").ok());
  }

  SmallDataset small_;
  ModelCatalogue models_{std::string(BELVEDERE_SOURCE_DIR) + "/servers/models", {{"car", 4.5F}}};
  ManualClock clock_;
  std::unique_ptr<LiveDataset> live_;
  ModuleRegistry registry_;
  std::unique_ptr<Paging> paging_;
  std::unique_ptr<DatasetFollower> follower_;
};

int32_t MiddleOf(const PagePin& elevation) {
  return elevation.as<ElevationPage>().at(64, 64);
}

TEST(DatasetFollower, NothingHappensWhereNothingChanged) {
  House house;
  const PagePin page = house.Read("terrain", kChanged);
  EXPECT_FALSE(house.follower_->Look());
  EXPECT_EQ(&house.Read("terrain", kChanged).page(), &page.page());
  EXPECT_EQ(house.paging_->generation, 0u);
}

TEST(DatasetFollower, PagesInUseAreMadeAnew) {
  House house;
  const PagePin heights = house.Read("elevation", kChanged), terrain = house.Read("terrain", kChanged);
  const PagePin relief = house.Read("relief", kChanged);
  const PagePin far = house.Read("terrain", kFar);
  house.Raise(kChanged, 500);
  ASSERT_TRUE(house.follower_->Look());
  EXPECT_EQ(house.paging_->generation, 1u);
  for (const char* layer : {"elevation", "terrain", "relief"})
    EXPECT_TRUE(house.paging_->cache.Contains(house.Key(layer, kChanged))) << layer << " is there at once";
  EXPECT_EQ(MiddleOf(house.Read("elevation", kChanged)), MiddleOf(heights) + 500'000);
  EXPECT_NE(&house.Read("terrain", kChanged).page(), &terrain.page());
  EXPECT_NEAR(house.Read("terrain", kChanged).as<TerrainPage>().max_height_m,
              terrain.as<TerrainPage>().max_height_m + 500, 1);
  EXPECT_EQ(&house.Read("terrain", kFar).page(), &far.page()) << "what the change does not reach stays";
  EXPECT_FALSE(house.follower_->Look());
}

// Its normals and borders are made with the neighbour's heights.
TEST(DatasetFollower, NeighboursAreMadeAnewToo) {
  House house;
  const Quadcode beside = Quadcode::Root(19);
  const PagePin neighbour = house.Read("terrain", beside);
  house.Raise(kChanged, 500);
  ASSERT_TRUE(house.follower_->Look());
  EXPECT_NE(&house.Read("terrain", beside).page(), &neighbour.page());
}

TEST(DatasetFollower, StalePagesThatNobodyUsesAreGone) {
  House house;
  house.Read("elevation", kChanged).Release();
  house.Read("elevation", kFar).Release();
  house.Raise(kChanged, 500);
  ASSERT_TRUE(house.follower_->Look());
  EXPECT_FALSE(house.paging_->cache.Contains(house.Key("elevation", kChanged)));
  EXPECT_TRUE(house.paging_->cache.Contains(house.Key("elevation", kFar)));
}

TEST(DatasetFollower, FinerPagesThanThereWereExist) {
  House house;
  const Quadcode fine = kFar.Child(2);
  EXPECT_FALSE(house.Exists("terrain", fine));
  house.Raise(kFar, 10);
  EXPECT_FALSE(house.Exists("terrain", fine)) << "before anybody has looked";
  ASSERT_TRUE(house.follower_->Look());
  EXPECT_TRUE(house.Exists("terrain", fine));
  EXPECT_TRUE(house.Read("terrain", fine));
}

TEST(DatasetFollower, AFailureMayBeMended) {
  House house;
  const PageKey key = house.Key("elevation", kFar);
  house.paging_->cache.MarkFailed(key, Status::Error("damaged"));
  house.Raise(kChanged, 1);
  ASSERT_TRUE(house.follower_->Look());
  EXPECT_TRUE(house.Read("elevation", kFar));
}

TEST(DatasetFollower, AnotherBuildTakesTheWholesPlace) {
  House house;
  const PagePin far = house.Read("elevation", kFar);
  {
    auto writer = DatasetWriter::Create(house.small_.path());
    ASSERT_TRUE(writer.ok());
    const auto flat = [](GridPoint) { return 12.0; };
    const std::vector<uint8_t> white = EncodeImage(std::vector<uint8_t>(kImageTexels * 4, 255));
    for (int tree = 0; tree < kTrees; ++tree) {
      const Quadcode root = Quadcode::Root(tree);
      ASSERT_TRUE((*writer)->Put(0, root, EncodeElevation(*MakeElevation(root, flat))).ok());
      ASSERT_TRUE((*writer)->Put(1, root, white).ok());
      ASSERT_TRUE((*writer)->Put(2, root, white).ok());
    }
    std::vector<LayerRecord> layers = (*house.small_).layers();
    layers.push_back(layers[1]);
    layers.back().name = "photo";
    ASSERT_TRUE((*writer)->Finish(layers, "2026-03-03T00:00:00Z").ok());
  }
  ASSERT_TRUE(house.follower_->Look());
  EXPECT_EQ(MiddleOf(house.Read("elevation", kFar)), 12'000);
  EXPECT_FALSE(house.Exists("elevation", kChanged.Child(0))) << "it is no longer there";
  ASSERT_EQ(house.follower_->Notices().size(), 1u);
  EXPECT_NE(house.follower_->Notices()[0].find("has a new layer photo"), std::string::npos);
}

// Its pages would be shown by what the bytes meant before.
TEST(DatasetFollower, ALayerThatMeansSomethingElseIsNotFollowed) {
  House house;
  auto writer = ChangeWriter::Create(house.small_.path());
  ASSERT_TRUE(writer.ok());
  std::vector<LayerRecord> layers = (*house.small_).layers();
  layers[1].step = StepOf{"imagery", 5, Repeats::kNever};
  ASSERT_TRUE((*writer)->Finish(layers, "2026-03-03T00:00:00Z").ok());
  EXPECT_FALSE(house.follower_->Look());
  ASSERT_EQ(house.follower_->Notices().size(), 1u);
  EXPECT_NE(house.follower_->Notices()[0].find("no layer imagery as it was"), std::string::npos);
}

// A server that is at the disk keeps the change waiting, and no manager.
TEST(DatasetFollower, ManagersWaitForNoDisk) {
  House house;
  house.Raise(kChanged, 500);
  std::thread follower;
  {
    const GatePass slow(house.paging_->reading);
    follower = std::thread([&house] { house.follower_->Look(); });
    for (int list = 0; list < 100; ++list) const GatePass pass(house.paging_->listing);
    EXPECT_EQ(house.paging_->generation, 0u);
  }
  follower.join();
  EXPECT_EQ(house.paging_->generation, 1u);
}

TEST(DatasetFollower, GoesOnWhereWhatIsThereCannotBeUsed) {
  House house;
  const PagePin far = house.Read("elevation", kFar);
  {
    auto writer = DatasetWriter::Create(house.small_.path());
    ASSERT_TRUE(writer.ok());
    ASSERT_TRUE((*writer)->Finish({(*house.small_).layers()[1]}, "2026-03-03T00:00:00Z").ok());
  }
  EXPECT_FALSE(house.follower_->Look());
  ASSERT_EQ(house.follower_->Notices().size(), 1u);
  EXPECT_NE(house.follower_->Notices()[0].find("has no layer elevation as it was"), std::string::npos);
  std::ofstream(house.small_.path() + "/data.mdb") << "no store";
  EXPECT_FALSE(house.follower_->Look());
  EXPECT_NE(house.follower_->Notices()[0].find("cannot open"), std::string::npos);
  EXPECT_EQ(&house.Read("elevation", kFar).page(), &far.page());
  EXPECT_TRUE(house.Read("elevation", kChanged)) << "what is open is still read";
}

TEST(DatasetFollower, FollowsOnAThreadOfItsOwn) {
  House house;
  const PagePin page = house.Read("elevation", kChanged);
  DatasetFollower follower(*house.paging_, *house.live_, house.models_, {}, Clock::System());
  house.Raise(kChanged, 500);
  while (house.paging_->generation == 0) std::this_thread::yield();
  EXPECT_EQ(MiddleOf(house.Read("elevation", kChanged)), MiddleOf(page) + 500'000);
}

TEST(ChangedPages, ReachWhatLiesUnderAndAroundThem) {
  House house;
  const std::shared_ptr<const Dataset> before = house.live_->current();
  house.Raise(kChanged, 1);
  const auto after = Dataset::Open(house.small_.path());
  ASSERT_TRUE(after.ok());
  const ChangedPages changed = ChangedPages::Between(*before, **after);
  EXPECT_FALSE(changed.all());
  EXPECT_EQ(changed.count(), 5u);
  EXPECT_TRUE(changed.MayReach(kChanged));
  EXPECT_TRUE(changed.MayReach(kChanged.Child(1).Child(2)));
  EXPECT_TRUE(changed.MayReach(Quadcode::Root(21)));
  EXPECT_FALSE(changed.MayReach(kFar));
  EXPECT_FALSE(ChangedPages::Between(**after, **after).MayReach(kChanged));
  EXPECT_TRUE(ChangedPages::Between(**after, *before).all()) << "back to what was under it";
}

}  // namespace
}  // namespace belvedere

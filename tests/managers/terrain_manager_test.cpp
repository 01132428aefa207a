#include "managers/terrain_manager.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <thread>

namespace belvedere {
namespace {

constexpr DataType kTerrain = 0;

// Lists of a running manager, as the render thread would fetch them; every page it wishes for is made at once.
class TerrainManagerTest : public testing::Test {
 protected:
  TerrainManagerTest() {
    view_.view = 1;
    view_.number = 1;
    view_.eye_ecef = ToEcef({20, 30, 3e6});
    view_.ecef_from_camera = CameraAxes(20, 30, {}, Radians::FromDegrees(-90), {});
    channel_->parameters.Publish(view_);
  }

  static LayerTable Layers() {
    LayerTable layers;
    layers.Add({"terrain", PageKind::kTerrain, 0, 2, [](Quadcode node) { return node.level() <= 2; }});
    return layers;
  }

  // The next list, once there is one.
  const DisplayList& NextList() {
    while (!channel_->terrain_lists.Fetch()) std::this_thread::yield();
    return channel_->terrain_lists.front();
  }

  void Serve() {
    while (const std::optional<PageKey> key = paging_.queue(kTerrain).TryTake()) {
      auto page = test::FlatPage(key->node, std::vector<float>(kVerticesPerPage, 1.0F));
      page->error_m = key->node.level() < 2 ? 20'000.0F : 0.0F;
      kept_.push_back(paging_.cache.Insert(*key, std::move(page)));
      paging_.queue(kTerrain).Done(*key);
    }
  }

  Paging paging_{Layers(), size_t{1} << 30, Clock::System()};
  std::shared_ptr<ViewChannel> channel_ = std::make_shared<ViewChannel>();
  ViewParameters view_;
  std::vector<PagePin> kept_;
};

TEST_F(TerrainManagerTest, GoesFromNothingToASettledCut) {
  TerrainManager manager(1, paging_, channel_, {}, Clock::System());
  uint32_t nodes = 0;
  while (true) {
    const DisplayList& list = NextList();
    EXPECT_GE(list.statistics.nodes, nodes) << "a still eye never sees the cut grow coarser";
    nodes = list.statistics.nodes;
    if (list.statistics.settled) break;
    Serve();
  }
  const DisplayList& list = channel_->terrain_lists.front();
  EXPECT_GT(nodes, 32U);
  EXPECT_EQ(list.terrain_draws.size(), nodes);
  EXPECT_EQ(list.view_number, 1U);
  EXPECT_FALSE(list.statistics.behind);
  EXPECT_LE(list.statistics.achieved_error_px, view_.error_px * 1.001);
  EXPECT_NEAR(list.statistics.height_above_ground_m, 3e6, 10);
}

TEST_F(TerrainManagerTest, ChangedPagesGiveANewListOfASettledView) {
  TerrainManager manager(1, paging_, channel_, {}, Clock::System());
  while (!NextList().statistics.settled) Serve();
  const uint64_t before = channel_->terrain_lists.front().number;
  paging_.listing.Close();  // no list is being made from here on
  for (const PageKey& key : paging_.cache.Keys(SharedCache::Which::kAll)) {
    auto page = test::FlatPage(key.node, std::vector<float>(kVerticesPerPage, 1.0F));
    page->max_height_m = 77;
    paging_.cache.Replace(key, std::move(page));
  }
  paging_.generation.fetch_add(1);
  paging_.listing.Open();
  while (!NextList().statistics.settled) Serve();
  EXPECT_GT(channel_->terrain_lists.front().number, before);
  int changed = 0;
  for (const PagePin& pin : channel_->terrain_lists.front().page_pins)
    changed += pin.key().type == kTerrain && pin.as<TerrainPage>().max_height_m == 77 ? 1 : 0;
  EXPECT_GT(changed, 30);
}

TEST_F(TerrainManagerTest, ANewViewGivesANewList) {
  TerrainManager manager(1, paging_, channel_, {}, Clock::System());
  while (!NextList().statistics.settled) Serve();
  view_.number = 2;
  view_.eye_ecef = ToEcef({20, 30, 2e6});
  channel_->parameters.Publish(view_);
  while (NextList().view_number != 2 || !channel_->terrain_lists.front().statistics.settled) {
    Serve();
  }
  EXPECT_NEAR(channel_->terrain_lists.front().statistics.height_above_ground_m, 2e6, 10);
}

TEST_F(TerrainManagerTest, WithdrawsItsWishesWhenItEnds) {
  {
    TerrainManager manager(1, paging_, channel_, {}, Clock::System());
    NextList();
  }
  EXPECT_EQ(paging_.queue(kTerrain).Stats().waiting, 0U);
  EXPECT_GT(paging_.queue(kTerrain).Stats().cancelled, 0U);
}

}  // namespace
}  // namespace belvedere

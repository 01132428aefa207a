// A running terrain manager whose layer changes with the simulation time: what its lists show and wish for meanwhile.
#include "managers/terrain_manager.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <thread>

namespace belvedere {
namespace {

constexpr DataType kTerrain = 0;
constexpr DataType kFirstStep = 1;
constexpr int kSteps = 12;
constexpr double kStep_s = 100.0;
constexpr int kDeepest = 2;
constexpr double kBlended_s = 0.31;

LayerTable Layers() {
  LayerTable layers;
  const auto exists = [](Quadcode node) { return node.level() <= kDeepest; };
  layers.Add({"terrain", PageKind::kTerrain, 0, kDeepest, exists});
  for (int step = 0; step < kSteps; ++step) {
    Layer layer{step == 0 ? "months" : "months@" + std::to_string(step), PageKind::kColour, 0, kDeepest, exists};
    layer.step = StepOf{"months", kStep_s * step, Repeats::kNever};
    layers.Add(std::move(layer));
  }
  return layers;
}

// The test is server and render thread: pages and places on the GPU come when it says.
class ChangingLayersTest : public testing::Test {
 protected:
  ChangingLayersTest() {
    view_.view = 1;
    view_.number = 1;
    view_.eye_ecef = ToEcef({20, 30, 3e6});
    view_.ecef_from_camera = CameraAxes(20, 30, {}, Radians::FromDegrees(-90), {});
    view_.image_layers = {{kFirstStep}};
    channel_->parameters.Publish(view_);
  }
  void Start(ImageLimits slots = {}) {
    manager_ = std::make_unique<TerrainManager>(1, paging_, channel_, slots, clock_);
    while (!NextList().statistics.settled) Serve(1000);
  }
  const DisplayList& NextList() {
    while (!channel_->terrain_lists.Fetch()) std::this_thread::yield();
    return channel_->terrain_lists.front();
  }
  const DisplayList& list() const { return channel_->terrain_lists.front(); }

  // Serves at most so many wishes and uploads.
  void Serve(int most) {
    for (DataType type = 0; type < paging_.layers.size(); ++type) {
      while (most > 0) {
        const std::optional<PageKey> key = paging_.queue(type).TryTake();
        if (!key) break;
        served_.insert(key->type);
        if (fails_.contains(key->type)) {
          paging_.cache.MarkFailed(*key, Status::Error("damaged"));
        } else {
          kept_.push_back(paging_.cache.Insert(*key, Make(*key)));
        }
        paging_.queue(type).Done(*key);
        --most;
      }
    }
    for (const PagePin& pin : list().uploads) {
      if (most-- <= 0) return;
      if (!pin.page().residency()->on_gpu()) pin.page().residency()->Place(slots_++);
    }
  }
  static std::unique_ptr<Page> Make(const PageKey& key) {
    if (key.type != kTerrain) return std::make_unique<ImagePage>();
    auto page = test::FlatPage(key.node, std::vector<float>(kVerticesPerPage, 1.0F));
    page->error_m = key.node.level() < kDeepest ? 20'000.0F : 0.0F;
    return page;
  }
  // Of each quadnode of the list, the level of the image that it shows.
  std::map<Quadcode, int> Shown() const {
    std::map<Quadcode, int> levels;
    for (const TerrainDraw& draw : list().terrain_draws) {
      EXPECT_GE(draw.images[0].slot, 0) << draw.node.ToString() << " is blank";
      levels[draw.node] = draw.images[0].source.level();
    }
    return levels;
  }
  std::set<DataType> TypesShown() const {
    std::set<DataType> types;
    for (const TerrainDraw& draw : list().terrain_draws) types.insert(draw.images[0].type);
    return types;
  }

  ManualClock clock_;
  Paging paging_{Layers(), size_t{1} << 30, clock_};
  std::shared_ptr<ViewChannel> channel_ = std::make_shared<ViewChannel>();
  ViewParameters view_;
  std::vector<PagePin> kept_;
  std::set<DataType> served_, fails_;
  int slots_ = 0;
  std::unique_ptr<TerrainManager> manager_;
};

TEST_F(ChangingLayersTest, AStillViewGoesOnToTheNextStepWithoutAFlash) {
  Start();
  EXPECT_EQ(TypesShown(), (std::set<DataType>{kFirstStep}));
  const std::map<Quadcode, int> before = Shown();
  served_.clear();
  clock_.Advance(kStep_s);  // nobody publishes anything
  EXPECT_FALSE(NextList().statistics.settled);
  EXPECT_EQ(TypesShown(), (std::set<DataType>{kFirstStep})) << "nothing of the next step is there yet";
  bool blended = false;
  while (!NextList().statistics.settled) {
    EXPECT_TRUE(Shown() == before) << "an image is coarser than it was";
    for (const TerrainDraw& draw : list().terrain_draws) {
      if (draw.fade_s[0] <= 0) continue;
      blended = true;
      EXPECT_EQ(draw.from[0].type, kFirstStep);
      EXPECT_EQ(draw.images[0].type, kFirstStep + 1);
    }
    Serve(1);
  }
  EXPECT_TRUE(blended);
  EXPECT_EQ(TypesShown(), (std::set<DataType>{kFirstStep + 1}));
  EXPECT_EQ(served_, (std::set<DataType>{kFirstStep + 1}));
  EXPECT_GT(list().statistics.rises_until_s, clock_.NowSeconds());
}

TEST_F(ChangingLayersTest, WhereTimeStandsStillSoDoesTheLayer) {
  view_.time_rate = 0;
  channel_->parameters.Publish(view_);
  Start();
  clock_.Advance(5 * kStep_s);
  view_.number = 2;
  channel_->parameters.Publish(view_);
  while (NextList().view_number != 2) continue;
  EXPECT_EQ(TypesShown(), (std::set<DataType>{kFirstStep}));
}

// A step passes by with every second list, and pages come slowly.
TEST_F(ChangingLayersTest, AtAHighRateOneStepAfterTheOtherIsFetchedAndOthersAreLeftOut) {
  view_.time_rate = 500;
  channel_->parameters.Publish(view_);
  Start();
  const std::map<Quadcode, int> before = Shown();
  served_.clear();
  for (int i = 0; i < 2 * kSteps; ++i) {
    clock_.Advance(0.1);
    ++view_.number;
    channel_->parameters.Publish(view_);
    NextList();
    EXPECT_TRUE(Shown() == before);
    EXPECT_LE(TypesShown().size(), 3U) << "one is going, one is there, one comes";
    std::set<DataType> wished;
    for (DataType type = kFirstStep; type < paging_.layers.size(); ++type) {
      if (paging_.queue(type).Stats().waiting > 0) wished.insert(type);
    }
    EXPECT_LE(wished.size(), 1U) << "list " << i;
    Serve(20);
  }
  while (!NextList().statistics.settled || TypesShown() != std::set<DataType>{kFirstStep + kSteps - 1}) {
    EXPECT_TRUE(Shown() == before);
    clock_.Advance(kBlended_s);
    Serve(10);
  }
  EXPECT_LT(served_.size(), 6U) << "a step that is not shown is not fetched";
}

TEST_F(ChangingLayersTest, BothStepsTogetherKeepToTheSlotsOfTheGpu) {
  const auto in_use = [&] {  // roots not counted: they may always come
    std::set<PageKey> images;
    for (const TerrainDraw& draw : list().terrain_draws) {
      if (!draw.images[0].source.is_root()) images.insert({draw.images[0].type, draw.images[0].source});
    }
    for (const PagePin& pin : list().uploads) {
      if (!pin.key().node.is_root()) images.insert(pin.key());
    }
    return static_cast<int>(images.size());
  };
  Start();
  const int needed = in_use();
  ASSERT_GT(needed, 20);
  manager_.reset();
  const int slots = (needed + kTrees + 8) * 5 / 4;  // of which a list uses four fifths
  Start({.colour = slots});
  clock_.Advance(kStep_s);
  while (!NextList().statistics.settled) {
    EXPECT_LE(in_use(), needed + kTrees + 8);
    clock_.Advance(kBlended_s);
    Serve(100);
  }
  EXPECT_EQ(TypesShown(), std::set<DataType>{kFirstStep + 1});
}

TEST_F(ChangingLayersTest, FailedPagesEndAChangeInTime) {
  Start();
  fails_ = {kFirstStep + 1};
  clock_.Advance(kStep_s);
  for (int i = 0; i < 5; ++i) {
    NextList();
    Serve(1000);
  }
  EXPECT_FALSE(list().statistics.settled) << "it is still waited for";
  clock_.Advance(4.0);
  while (!NextList().statistics.settled) Serve(1000);
}

}  // namespace
}  // namespace belvedere

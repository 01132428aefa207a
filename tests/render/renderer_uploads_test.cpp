// Pages on their way to the GPU: budget, order, eviction.
#include "render/renderer.h"

#include "tests/render/synthetic_scene.h"

#include <gtest/gtest.h>

namespace belvedere::testing {
namespace {

// A clock on which everything takes a millisecond.
class BusyClock final : public Clock {
 public:
  double NowSeconds() const override { return 0.001 * static_cast<double>(++calls_); }
  double UtcSeconds() const override { return NowSeconds(); }

 private:
  mutable int64_t calls_ = 0;
};

class Uploads : public ::testing::Test {
 protected:
  void Open(const RenderOptions& options) {
    auto stage = Stage::Make(scene_, options, clock_);
    ASSERT_TRUE(stage.ok()) << stage.message();
    stage_ = std::move(*stage);
    stage_->channel->parameters.Publish(LookAt({0, 0, 1000}, 0, -90, 32, 32));
  }
  void Wish(const std::vector<Quadcode>& nodes, ViewChannel& channel) {
    DisplayList& list = channel.terrain_lists.back();
    list.Clear();
    for (const Quadcode node : nodes) {
      list.uploads.push_back(scene_.AddOverlay(node, 9));
    }
    channel.terrain_lists.Publish();
  }
  bool OnGpu(Quadcode node) {
    const PagePin pin = scene_.Find(scene_.overlay_type(), node);
    return pin && pin.page().residency()->on_gpu();
  }
  int CountOnGpu(const std::vector<Quadcode>& nodes) {
    int count = 0;
    for (const Quadcode node : nodes) count += OnGpu(node) ? 1 : 0;
    return count;
  }

  const BusyClock clock_;
  Scene scene_;
  std::unique_ptr<Stage> stage_;
};

TEST_F(Uploads, StayWithinTheBudgetMostWantedFirst) {
  RenderOptions options;
  options.overlay_slots = 16;
  options.upload_budget_ms = 3;
  ASSERT_NO_FATAL_FAILURE(Open(options));
  const std::vector<Quadcode> nodes = Block(0, 0, 10, 3);
  Wish(nodes, *stage_->channel);
  stage_->Frame();
  EXPECT_EQ(CountOnGpu(nodes), 3);  // a millisecond each
  EXPECT_TRUE(OnGpu(nodes[0]) && OnGpu(nodes[1]) && OnGpu(nodes[2]));
  EXPECT_EQ(stage_->channel->frame.Get()->uploads_pending, 6U);
  EXPECT_EQ(stage_->recorder.Take().back().upload_bytes, 3 * ImagePage::MipOffset(kImageMipLevels, ImageFormat::kR8));
  stage_->Frame();
  stage_->Frame();
  EXPECT_EQ(CountOnGpu(nodes), 9);
  EXPECT_EQ(stage_->channel->frame.Get()->uploads_pending, 0U);
}

TEST_F(Uploads, OnePageIsAlwaysUploaded) {
  RenderOptions options;
  options.upload_budget_ms = 0;
  ASSERT_NO_FATAL_FAILURE(Open(options));
  const std::vector<Quadcode> nodes = Block(0, 0, 10, 2);
  Wish(nodes, *stage_->channel);
  stage_->Frame();
  EXPECT_EQ(CountOnGpu(nodes), 1);
}

TEST_F(Uploads, ViewsShareTheBudget) {
  RenderOptions options;
  options.upload_budget_ms = 4;
  ASSERT_NO_FATAL_FAILURE(Open(options));
  const auto second = std::make_shared<ViewChannel>();
  second->parameters.Publish(LookAt({0, 0, 1000}, 0, -90, 32, 32));
  stage_->renderer->AddView(2, second, nullptr);
  const std::vector<Quadcode> here = Block(0, 0, 10, 3);
  const std::vector<Quadcode> there = Block(50, 50, 10, 3);
  Wish(here, *stage_->channel);
  Wish(there, *second);
  stage_->Frame();
  EXPECT_EQ(CountOnGpu(here), 2);
  EXPECT_EQ(CountOnGpu(there), 2);
}

TEST_F(Uploads, AFullPoolEvictsWhatNobodyPinsAndRefusesTheRest) {
  RenderOptions options;
  options.overlay_slots = 4;
  options.upload_budget_ms = 1000;
  ASSERT_NO_FATAL_FAILURE(Open(options));
  const std::vector<Quadcode> first = Block(0, 0, 10, 2);
  Wish(first, *stage_->channel);
  stage_->Frame();
  ASSERT_EQ(CountOnGpu(first), 4);
  // A list that draws two of them, and wishes for four others.
  DisplayList& list = stage_->channel->terrain_lists.back();
  list.Clear();
  for (const Quadcode node : {first[0], first[1]}) scene_.AddTerrain(node, [](double, double) { return 0.0; });
  AddSurface(list, scene_, {first[0], first[1]}, 64);
  const std::vector<Quadcode> others = Block(50, 50, 10, 2);
  for (const Quadcode node : others) list.uploads.push_back(scene_.AddOverlay(node, 9));
  stage_->channel->terrain_lists.Publish();
  for (uint64_t i = 0; i <= SlotPool::kGraceFrames + 1; ++i) stage_->Frame();
  EXPECT_TRUE(OnGpu(first[0]) && OnGpu(first[1]));
  EXPECT_FALSE(OnGpu(first[2]) || OnGpu(first[3]));
  EXPECT_EQ(CountOnGpu(others), 2);
  EXPECT_EQ(stage_->channel->frame.Get()->uploads_pending, 2U);
  EXPECT_GT(stage_->renderer->pages().overlay_pool().refused(), 0U);
}

TEST_F(Uploads, ImageSlotsSayWhichFormatTheyAreOf) {
  RenderOptions options;
  options.colour_slots = 8;
  options.upload_budget_ms = 1000;
  ASSERT_NO_FATAL_FAILURE(Open(options));
  std::vector<PagePin> pins;
  pins.push_back(scene_.AddOverlay(Quadcode::Root(1), 9));
  pins.push_back(scene_.AddColour(Quadcode::Root(1), {1, 2, 3, 255}));
  stage_->Upload(std::move(pins));
  const auto slot_of = [&](DataType type) {
    const PagePin pin = scene_.Find(type, Quadcode::Root(1));
    const auto slot = pin.page().residency()->TryPin();
    pin.page().residency()->Unpin();
    return slot.value_or(-1);
  };
  const GpuPages& pages = stage_->renderer->pages();
  EXPECT_TRUE(pages.IsColour(slot_of(scene_.colour_type())));
  EXPECT_FALSE(pages.IsColour(slot_of(scene_.overlay_type())));
  EXPECT_EQ(pages.ArrayLayer(slot_of(scene_.overlay_type())), 0);
}

}  // namespace
}  // namespace belvedere::testing

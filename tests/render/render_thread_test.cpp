#include "render/render_thread.h"

#include "tests/render/synthetic_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>

namespace belvedere::testing {
namespace {

class Thread : public ::testing::Test {
 protected:
  void Start(double max_fps) {
    RenderOptions options;
    options.max_fps = max_fps;
    options.colour_slots = 4;
    options.overlay_slots = 4;
    auto context = MakeOffscreenContext();
    ASSERT_TRUE(context.ok()) << context.message();
    auto thread = RenderThread::Start(options, scene_.layers(), Clock::System(), std::move(*context));
    ASSERT_TRUE(thread.ok()) << thread.message();
    thread_ = std::move(*thread);
  }
  std::shared_ptr<ViewChannel> Channel() {
    auto channel = std::make_shared<ViewChannel>();
    channel->parameters.Publish(LookAt({0, 0, 5000}, 0, -90, 32, 24));
    return channel;
  }
  // Orders are carried out between frames.
  void WaitForFrames(const ViewChannel& channel, uint64_t frames) {
    while (channel.frame.Get()->frame < frames) EXPECT_TRUE(thread_->Redraw(99, 1).get().empty());
  }

  Scene scene_;
  std::unique_ptr<RenderThread> thread_;
};

TEST_F(Thread, DrawsViewsUntilTheyAreRemoved) {
  ASSERT_NO_FATAL_FAILURE(Start(0));
  const auto channel = Channel();
  thread_->AddView(1, channel);
  // Orders are carried out in turn: this one comes back after at least the first frame could be drawn.
  auto picture = thread_->Capture(1, Renderer::Moment::kOfParameters).get();
  ASSERT_TRUE(picture.ok()) << picture.message();
  EXPECT_EQ(picture->width_px, 32);
  EXPECT_EQ(picture->rgb.size(), 3U * 32 * 24);
  thread_->RemoveView(1);
  const uint64_t frames = channel->frame.Get()->frame;
  EXPECT_FALSE(thread_->Capture(1, Renderer::Moment::kOfParameters).get().ok());
  EXPECT_EQ(channel->frame.Get()->frame, frames);
}

TEST_F(Thread, RedrawsTheSameListsAsOftenAsAsked) {
  ASSERT_NO_FATAL_FAILURE(Start(0));
  const auto channel = Channel();
  thread_->AddView(1, channel);
  WaitForFrames(*channel, 1);
  EXPECT_EQ(thread_->Redraw(1, 7).get().size(), 7U);
  EXPECT_EQ(thread_->Redraw(1, 7, true).get().size(), 7U);
  EXPECT_TRUE(thread_->Redraw(99, 7).get().empty());
}

TEST_F(Thread, RecordsEveryFrame) {
  ASSERT_NO_FATAL_FAILURE(Start(0));
  const auto channel = Channel();
  ViewParameters flying = *channel->parameters.Get();
  flying.eye_velocity_mps = {1, 0, 0};
  channel->parameters.Publish(flying);
  thread_->AddView(5, channel);
  WaitForFrames(*channel, 3);
  const auto samples = thread_->TakeSamples();
  ASSERT_GE(samples.size(), 3U);
  EXPECT_TRUE(std::all_of(samples.begin(), samples.end(), [](const FrameSample& s) { return s.view == 5; }));
  for (size_t i = 1; i < samples.size(); ++i) EXPECT_EQ(samples[i].frame, samples[i - 1].frame + 1);
}

TEST_F(Thread, AnswersAfterItStopped) {
  ASSERT_NO_FATAL_FAILURE(Start(60));
  thread_->AddView(1, Channel());
  thread_->Stop();
  EXPECT_FALSE(thread_->Capture(1, Renderer::Moment::kOfParameters).get().ok());
  EXPECT_TRUE(thread_->Redraw(1, 3).get().empty());
  thread_->RemoveView(1);
  thread_->Stop();
}

class NoContext final : public Context {
 public:
  Status MakeCurrent() override { return Status::Error("test: no context today"); }
  void Release() override {}
};

TEST_F(Thread, SaysWhyItCannotStart) {
  auto thread = RenderThread::Start({}, scene_.layers(), Clock::System(), std::make_unique<NoContext>());
  ASSERT_FALSE(thread.ok());
  EXPECT_EQ(thread.message(), "test: no context today");
}

}  // namespace
}  // namespace belvedere::testing

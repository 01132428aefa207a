// Windows; needs a display (Xvfb will do) and is skipped without one.
#include "render/window_system.h"

#include "tests/render/synthetic_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

// The display's libraries leak a few bytes and are unloaded before a leak checker could name them.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}

namespace belvedere::testing {
namespace {

TEST(WindowSystem, ShowsViewsInTwoWindows) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no DISPLAY: run under Xvfb to test windows";
  auto made = WindowSystem::Make(Clock::System());
  ASSERT_TRUE(made.ok()) << made.message();
  WindowSystem& windows = **made;
  Scene scene;
  RenderOptions options;
  options.colour_slots = options.overlay_slots = 4;
  auto thread = RenderThread::Start(options, scene.layers(), Clock::System(), windows.SharedContext());
  ASSERT_TRUE(thread.ok()) << thread.message();

  std::vector<WindowId> ids;
  std::vector<std::shared_ptr<ViewChannel>> channels;
  for (ViewId view = 1; view <= 2; ++view) {
    auto window = windows.CreateWindow({"test", 120, 90, 10, 10, false});
    ASSERT_TRUE(window.ok()) << window.message();
    ids.push_back(*window);
    EXPECT_EQ(windows.SizeOf(*window).width_px, 120);
    channels.push_back(std::make_shared<ViewChannel>());
    channels.back()->parameters.Publish(LookAt({0, 0, 5000}, 0, -90, 120, 90));
    (*thread)->AddView(view, channels.back(), windows.PresenterOf(*window));
  }
  std::vector<InputEvent> events;
  while (channels[0]->frame.Get()->frame < 5 || channels[1]->frame.Get()->frame < 5) windows.PollEvents(events, 0.01);
  auto picture = (*thread)->Capture(2, Renderer::Moment::kOfParameters).get();
  ASSERT_TRUE(picture.ok()) << picture.message();
  EXPECT_EQ(picture->rgb[0], 255);  // magenta
  EXPECT_EQ(picture->rgb[1], 0);

  // One window closes while the other goes on.
  (*thread)->RemoveView(1);
  windows.CloseWindow(ids[0]);
  const uint64_t frames = channels[1]->frame.Get()->frame;
  while (channels[1]->frame.Get()->frame < frames + 3) windows.PollEvents(events, 0.01);
  (*thread)->Stop();
}

void ExitWithOutcome() {
  const auto windows = WindowSystem::Make(Clock::System());
  std::fprintf(stderr, "%s\n", windows.ok() ? "windows" : windows.message().c_str());
  std::exit(windows.ok() ? 0 : 1);
}

TEST(WindowSystemDeathTest, NoDisplayGivesOneLine) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        unsetenv("DISPLAY");
        unsetenv("WAYLAND_DISPLAY");
        ExitWithOutcome();
      },
      ::testing::ExitedWithCode(1), "display: none can be opened: .*--headless");
}

TEST(WindowSystemDeathTest, AnOlderOpenGLIsNamed) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no DISPLAY: run under Xvfb to test windows";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        ExitWithOutcome();
      },
      ::testing::ExitedWithCode(1), "display: OpenGL 4.5 core is needed, found 3\\.3");
}

}  // namespace
}  // namespace belvedere::testing

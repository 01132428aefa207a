// WindowSystem: windows on a display, and what a person does in them.
//
// All windows share one hidden context, in which the render thread draws; each has a context of its own that only shows
// the finished picture. A window's picture size goes to the UI thread as a kResize event, which puts it into the view's
// parameters; the picture is stretched for the frame or two that this takes.
//
// Threads: everything by the main thread, except the Presenter of a window and the shared context, which the render
// thread
//          uses. A window may be closed when no view is shown in it any more (RenderThread::RemoveView has returned),
//          and the system destroyed when the render thread has stopped.
// Owns:    the windows. There is one WindowSystem a process.
#pragma once

#include "render/context.h"
#include "render/renderer.h"
#include "runtime/base/clock.h"
#include "runtime/base/status.h"
#include "runtime/scene/input.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace belvedere {

struct WindowOptions {
  std::string title = "Belvedere";
  int width_px = 1024, height_px = 768;
  std::optional<int> x_px, y_px;  // of the upper left corner; the window manager's choice without
  bool fullscreen = false;        // of the display's first monitor
};

class WindowSystem {
 public:
  // A Status when there is no display, or none with OpenGL 4.5. clock must live longer.
  static Result<std::unique_ptr<WindowSystem>> Make(const Clock& clock);
  ~WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;

  // The context for RenderThread::Start; once.
  std::unique_ptr<Context> SharedContext();

  Result<WindowId> CreateWindow(const WindowOptions& options);
  void CloseWindow(WindowId window);
  void SetTitle(WindowId window, const std::string& title);
  // Where RenderThread::AddView shows a view; lives until CloseWindow.
  Presenter* PresenterOf(WindowId window);
  // Of its picture, now.
  struct Size {
    int width_px = 0, height_px = 0;
  };
  Size SizeOf(WindowId window) const;

  // Appends what happened since the last call, in order. Waits for something to happen for at most that long.
  void PollEvents(std::vector<InputEvent>& events, double longest_wait_s = 0);
  // Ends the wait of PollEvents. The one method for any thread.
  static void Wake();

 private:
  struct State;
  explicit WindowSystem(std::unique_ptr<State> state);
  const std::unique_ptr<State> state_;
};

}  // namespace belvedere

// RenderThread: the one thread that draws all views, at most max_fps times a second, and shows them.
//
// Orders from other threads (add or remove a view, capture, redraw) wait in a queue and are carried out between two
// frames.
//
// Threads: all methods from any thread; Start and Stop by the UI thread. Stop and the destructor wait for the thread's
// end;
//          orders that still wait then fail.
// Owns:    the context and everything on the GPU. Channels are shared; windows must live until RemoveView or Stop
// returns.
#pragma once

#include "render/context.h"
#include "render/frame_recorder.h"
#include "render/picture.h"
#include "render/render_options.h"
#include "render/renderer.h"
#include "runtime/base/clock.h"
#include "runtime/paging/layer_table.h"
#include "runtime/scene/view_channel.h"

#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

namespace belvedere {

class RenderThread {
 public:
  // context: MakeOffscreenContext's, or WindowSystem::SharedContext's. Returns when the first frame can be drawn, or
  // why none can. layers and clock must live longer.
  static Result<std::unique_ptr<RenderThread>> Start(const RenderOptions& options, const LayerTable& layers,
                                                     const Clock& clock, std::unique_ptr<Context> context);
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;
  void Stop();

  // From the next frame on; presenter (a window) may be null: drawn for captures and reports alone. The view's size is
  // that of its parameters.
  void AddView(ViewId id, std::shared_ptr<ViewChannel> channel, Presenter* presenter = nullptr);
  // Returns when the view is not drawn any more: its window may be closed then.
  void RemoveView(ViewId id);

  // See Renderer::Capture and Redraw.
  std::future<Result<Picture>> Capture(ViewId id, Renderer::Moment moment);
  std::future<std::vector<double>> Redraw(ViewId id, int times, bool still = false);
  void SetNotices(std::vector<std::string> notices);

  // What frames cost since the last call, oldest first.
  std::vector<FrameSample> TakeSamples();
  const ContextFacts& facts() const;

 private:
  class Loop;
  explicit RenderThread(std::unique_ptr<Loop> loop);
  const std::unique_ptr<Loop> loop_;
};

}  // namespace belvedere

// TerrainManager: chooses, for one view, the quadnodes and vertices that keep the error on the screen under its bound,
// asks for the pages that it lacks, and publishes the surface as display lists.
//
// It owns a thread that wakes when the view changed or pages arrived, at most 34 times a second, runs the
// pure code of cut.h and surface_mesh.h, and publishes through the view's triple buffer. It never waits for a server or
// for the render thread.
//
// Threads: constructed and destroyed by the UI thread; destroying stops the thread and withdraws the view's wishes.
#pragma once

#include "managers/list_pages.h"
#include "runtime/base/clock.h"
#include "runtime/paging/paging.h"
#include "runtime/scene/view_channel.h"

#include <memory>

namespace belvedere {

class TerrainManager {
 public:
  // slots: for images on the GPU, of all views. A list uses no more than fit; what they would sharpen stays coarser.
  TerrainManager(ViewId view, Paging& paging, std::shared_ptr<ViewChannel> channel, ImageLimits slots,
                 const Clock& clock);
  ~TerrainManager();
  TerrainManager(const TerrainManager&) = delete;
  TerrainManager& operator=(const TerrainManager&) = delete;

  // Lists published each second, over the last few seconds.
  double scene_hz() const;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
  const ViewId view_;
  Paging& paging_;
};

}  // namespace belvedere

// Renderer: draws the newest lists of all views, once a call. All of OpenGL that is not a window lies behind it; it has
// no thread and no pacing of its own (render_thread.h has).
//
// A frame: fetch every view's newest lists; upload wished pages within the budget; then for every view take its newest
// parameters, compute the matrices for now, cull, and draw terrain, objects, sky, and what lies over the picture.
//
// Units:   milliseconds for costs, seconds for times.
// Threads: one at a time, with the context current that it was made with.
// Owns:    everything on the GPU; of each view's channel, the consumer's side of its lists.
#pragma once

#include "render/context.h"
#include "render/effect_pass.h"
#include "render/frame_recorder.h"
#include "render/frame_target.h"
#include "render/gl_objects.h"
#include "render/gpu_pages.h"
#include "render/object_pass.h"
#include "render/overlay_pass.h"
#include "render/picture.h"
#include "render/render_options.h"
#include "render/sky_pass.h"
#include "render/terrain_pass.h"
#include "render/volume_pass.h"
#include "runtime/base/clock.h"
#include "runtime/scene/view_channel.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace belvedere {

// Shows what was drawn: a window.
class Presenter {
 public:
  virtual ~Presenter() = default;
  // Shows the texture; it may leave another context current.
  virtual void Present(GLuint colour_texture, int width, int height) = 0;
};

// Of terrain lists, taken to the GPU for all views together; a list that is larger comes in shares.
inline constexpr size_t kListBytesAFrame = size_t{6} << 20;

class Renderer {
 public:
  // REQUIRES: a context is current; layers and clock live longer.
  static Result<std::unique_ptr<Renderer>> Make(const RenderOptions& options, const LayerTable& layers,
                                                const Clock& clock);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // presenter: null for a view that nobody sees; it must live until RemoveView.
  void AddView(ViewId id, std::shared_ptr<ViewChannel> channel, Presenter* presenter);
  void RemoveView(ViewId id);

  // Draws one frame of all views and adds to `recorder`. `context` is made current again after each Present. A view of
  // which nothing has changed keeps its picture; false when that is so of all of them.
  bool DrawFrame(FrameRecorder& recorder, Context& context);

  // Draws the lists that the last frame drew once more, and reads them back: at the moment of the newest parameters, so
  // that a view that stands still gives the same picture every time, or at the last frame's, which is where moving
  // objects were seen last.
  enum class Moment { kOfParameters, kOfLastFrame };
  Result<Picture> Capture(ViewId id, Moment moment);

  // Draws the lists of the last frame `times` over, at its moment, with no uploads; what each took, milliseconds.
  // still: from the same buffers, objects neither moved nor placed anew.
  std::vector<double> Redraw(ViewId id, int times, bool still = false);

  // Lines that the heads-up displays show under their own, such as pages that failed.
  void SetNotices(std::vector<std::string> notices);

  const ContextFacts& facts() const { return facts_; }
  const GpuPages& pages() const { return pages_; }

 private:
  struct View;
  struct Drawn {
    uint32_t triangles = 0, nodes = 0;
  };
  Renderer(const RenderOptions& options, const LayerTable& layers, const Clock& clock, ContextFacts facts);

  View* Find(ViewId id);
  // Finds out which views have other parameters or other lists.
  void FetchNews();
  bool FetchNews(View& view, size_t& list_bytes_left);
  bool HasToBeDrawn(const View& view) const;
  static bool IsSettled(const View& view, const ViewParameters& parameters, double clock_now_s);
  void UploadPages();
  // now_s: of the view; clock_now_s: how far the surface is on its way.
  enum class Objects { kMoved, kStill };
  Drawn DrawView(View& view, const ViewParameters& parameters, double now_s, double clock_now_s,
                 Objects how = Objects::kMoved);
  void PlaceOverlay(View& view, const ViewParameters& parameters, double now_s);
  void Report(View& view, double frame_ms, double draw_ms, const Drawn& drawn, FrameRecorder& recorder);
  Picture ReadBack(const View& view, const ViewParameters& parameters, const Drawn& drawn, double clock_now_s) const;

  const RenderOptions options_;
  const Clock& clock_;
  const ContextFacts facts_;
  const Atlas atlas_;
  GpuPages pages_;
  TerrainPrograms terrain_programs_;
  SkyPass sky_;
  VolumePass volumes_;
  ObjectPass objects_;
  EffectPass effects_;
  OverlayPass overlay_;
  GlBuffer view_block_;
  FramesInFlight in_flight_;
  std::vector<std::unique_ptr<View>> views_;
  std::vector<std::string> notices_;
  uint64_t frame_ = 0;
  uint64_t notices_number_ = 0;
  std::optional<double> last_start_s_;
  double start_s_ = 0;
  double upload_ms_ = 0;
  double busy_ms_ = 0;  // of the last frame
  uint64_t upload_bytes_ = 0;
};

}  // namespace belvedere

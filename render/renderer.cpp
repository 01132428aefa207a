#include "render/renderer.h"

#include "render/drawn_ground.h"
#include "render/hud.h"
#include "render/moved_objects.h"
#include "render/object_overlay.h"
#include "render/upload_order.h"
#include "render/view_block.h"
#include "runtime/base/log.h"
#include "runtime/base/trace.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/sun.h"

#include <algorithm>
#include <span>
#include <utility>

namespace belvedere {
namespace {

constexpr double kHudRefresh_s = 0.25;
constexpr double kRateOfASunThatMoves = 60.0;  // a quarter of a degree a second
constexpr double kLongestUnchanged_s = 1.0;    // the sun goes on, and a window may have been uncovered
constexpr double kLeastOverGround_m = 1.0;

// Where the list draws its ground over the eye, since pages have not come, the picture is taken from just above that.
ViewMatrices MatricesOver(const DisplayList& terrain, const ViewParameters& parameters, double now_s,
                          double since_list_s) {
  const Geodetic eye = ToGeodetic(parameters.EyeAt(now_s));
  const double over_ground_m = eye.height_m - DrawnGroundAt(terrain, eye, since_list_s).value_or(0.0);
  if (over_ground_m >= kLeastOverGround_m) return MatricesOf(parameters, now_s, over_ground_m);
  ViewParameters raised = parameters;
  raised.eye_ecef += (kLeastOverGround_m - over_ground_m) * UpAt(eye.latitude_deg, eye.longitude_deg);
  return MatricesOf(raised, now_s, kLeastOverGround_m);
}

}  // namespace

struct Renderer::View {
  View(ViewId view_id, std::shared_ptr<ViewChannel> view_channel, Presenter* shown_by, const GpuPages& pages,
       TerrainPrograms& programs, const Atlas& atlas, int samples)
      : id(view_id),
        channel(std::move(view_channel)),
        presenter(shown_by),
        target(samples),
        terrain(pages, programs),
        overlay(atlas),
        hud(atlas) {}

  const ViewId id;
  const std::shared_ptr<ViewChannel> channel;
  Presenter* const presenter;
  FrameTarget target;
  TerrainPass terrain;
  OverlayBatch overlay, hud;
  bool has_terrain = false, has_objects = false;
  bool terrain_comes = false;                        // a list is on its way to the GPU
  std::shared_ptr<const ViewParameters> parameters;  // of the last frame
  double drawn_s = -1e9;                             // clock time that it showed
  bool has_news = false;                             // since then
  uint64_t notices_number = 0;
  ViewMatrices matrices;
  VisibleDraws visible, visible_objects;
  uint32_t uploads_pending = 0;
  FrameReport report;
  double hud_s = -1e9;
};

Result<std::unique_ptr<Renderer>> Renderer::Make(const RenderOptions& options, const LayerTable& layers,
                                                 const Clock& clock) {
  Result<ContextFacts> facts = InspectContext();
  if (!facts.ok()) return facts.status();
  RenderOptions complete = WithDefaults(options, facts->software);
  if (complete.samples < 0) {
    complete.samples = FrameTarget::SamplesWorthTheirTime(clock);
    LogInfo("render: {}: {} samples a pixel, as [render] samples does not say", facts->renderer, complete.samples);
  }
  auto renderer = std::unique_ptr<Renderer>(new Renderer(complete, layers, clock, std::move(*facts)));
  if (!renderer->atlas_.font().ok()) LogWarning("{}", renderer->atlas_.font().message());
  return renderer;
}

Renderer::Renderer(const RenderOptions& options, const LayerTable& layers, const Clock& clock, ContextFacts facts)
    : options_(options),
      clock_(clock),
      facts_(std::move(facts)),
      atlas_(options.font_path),
      pages_(options, layers, facts_),
      objects_(pages_),
      overlay_(atlas_),
      view_block_(GlBuffer::Make()) {
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glEnable(GL_CULL_FACE);
  glNamedBufferData(view_block_.get(), sizeof(ViewBlock), nullptr, GL_STREAM_DRAW);
}

Renderer::~Renderer() = default;

void Renderer::AddView(ViewId id, std::shared_ptr<ViewChannel> channel, Presenter* presenter) {
  views_.push_back(
      std::make_unique<View>(id, std::move(channel), presenter, pages_, terrain_programs_, atlas_, options_.samples));
}

void Renderer::RemoveView(ViewId id) {
  std::erase_if(views_, [&](const auto& view) { return view->id == id; });
}

Renderer::View* Renderer::Find(ViewId id) {
  const auto found = std::find_if(views_.begin(), views_.end(), [&](const auto& view) { return view->id == id; });
  return found == views_.end() ? nullptr : found->get();
}

void Renderer::SetNotices(std::vector<std::string> notices) {
  if (notices == notices_) return;
  notices_ = std::move(notices);
  ++notices_number_;
}

void Renderer::FetchNews() {
  const TraceSpan span("render.lists");
  size_t list_bytes_left = kListBytesAFrame;
  for (size_t i = 0; i < views_.size(); ++i) {
    View& view = *views_[(i + frame_) % views_.size()];  // each is the first in turn
    view.has_news |= FetchNews(view, list_bytes_left);
  }
}

bool Renderer::FetchNews(View& view, size_t& list_bytes_left) {
  bool news = false;
  if (auto newest = view.channel->parameters.Get(); newest != view.parameters) {
    view.parameters = std::move(newest);
    news = true;
  }
  TripleBuffer<DisplayList>& terrain = view.channel->terrain_lists;
  if (!view.terrain_comes) view.terrain_comes = terrain.Receive();
  if (view.terrain_comes && view.terrain.Send(terrain.coming(), list_bytes_left)) {
    news = true;
    view.terrain_comes = false;
    view.has_terrain = true;
    terrain.Show();
    pages_.Touch(terrain.front(), frame_);
    view.terrain.Show(terrain.front());
  }
  if (view.channel->object_lists.Fetch()) {
    news = true;
    view.has_objects = true;
    pages_.Touch(view.channel->object_lists.front(), frame_);
  }
  return news;
}

bool Renderer::HasToBeDrawn(const View& view) const {
  if (view.parameters->width_px <= 0 || view.parameters->height_px <= 0) return false;  // a minimised window
  const bool moves = view.parameters->eye_velocity_mps != glm::dvec3(0) ||
                     !view.channel->object_lists.front().instances.empty() ||
                     !view.channel->object_lists.front().effects.empty() ||
                     view.drawn_s < view.channel->terrain_lists.front().statistics.rises_until_s ||
                     std::abs(view.parameters->time_rate) > kRateOfASunThatMoves ||
                     view.uploads_pending != view.report.uploads_pending;
  return view.has_news || moves || view.notices_number != notices_number_ ||
         start_s_ - view.drawn_s >= kLongestUnchanged_s;
}

void Renderer::UploadPages() {
  const TraceSpan span("render.upload");
  const uint64_t bytes_before = pages_.uploaded_bytes();
  std::vector<std::span<const PagePin>> wishes;
  for (const auto& view : views_) {
    wishes.emplace_back(view->channel->terrain_lists.front().uploads);
    wishes.emplace_back(view->channel->object_lists.front().uploads);
  }
  const auto is_to_do = [](const PagePin& pin) { return !pin.page().residency()->on_gpu(); };
  const bool any = std::any_of(wishes.begin(), wishes.end(), [&](std::span<const PagePin> pins) {
    return std::any_of(pins.begin(), pins.end(), is_to_do);
  });
  if (any) in_flight_.Drain();  // so that the budget is spent on uploads and not on waiting
  const double start_s = clock_.NowSeconds();
  for (const PagePin* pin : FairUploadOrder(wishes, frame_)) {
    pages_.Upload(*pin, frame_);
    if ((clock_.NowSeconds() - start_s) * 1000 >= options_.upload_budget_ms) break;
  }
  for (const auto& view : views_) {
    view->uploads_pending = 0;
    for (const DisplayList* list : {&view->channel->terrain_lists.front(), &view->channel->object_lists.front()}) {
      view->uploads_pending +=
          static_cast<uint32_t>(std::count_if(list->uploads.begin(), list->uploads.end(), is_to_do));
    }
  }
  upload_bytes_ = pages_.uploaded_bytes() - bytes_before;
  upload_ms_ = (clock_.NowSeconds() - start_s) * 1000;
}

bool Renderer::DrawFrame(FrameRecorder& recorder, Context& context) {
  const TraceSpan span("render.frame");
  ++frame_;
  start_s_ = clock_.NowSeconds();
  FetchNews();
  UploadPages();
  const bool any = std::any_of(views_.begin(), views_.end(), [&](const auto& view) { return HasToBeDrawn(*view); });
  if (!any) {
    last_start_s_.reset();  // the next frame is not late
    return false;
  }
  const double frame_ms = last_start_s_ ? (start_s_ - *last_start_s_) * 1000 : 0;
  last_start_s_ = start_s_;
  for (const auto& view : views_) {
    if (!HasToBeDrawn(*view)) continue;
    const double view_start_s = clock_.NowSeconds();
    view->drawn_s = start_s_;
    view->has_news = false;
    view->notices_number = notices_number_;
    const Drawn drawn = DrawView(*view, *view->parameters, start_s_, start_s_);
    if (view->presenter == nullptr) in_flight_.EndFrame();
    const double draw_ms = (clock_.NowSeconds() - view_start_s) * 1000;
    if (view->presenter != nullptr) {
      glFinish();  // the window's context reads it
      view->presenter->Present(view->target.colour_texture(), view->target.width(), view->target.height());
      if (Status status = context.MakeCurrent(); !status.ok()) LogError("{}", status.message());
    }
    Report(*view, frame_ms, draw_ms, drawn, recorder);
  }
  busy_ms_ = (clock_.NowSeconds() - start_s_) * 1000;
  return true;
}

Renderer::Drawn Renderer::DrawView(View& view, const ViewParameters& parameters, double now_s, double clock_now_s,
                                   Objects how) {
  const DisplayList& terrain = view.channel->terrain_lists.front();
  const DisplayList& objects = view.channel->object_lists.front();
  const double since_list_s = clock_now_s - terrain.time_s;
  view.matrices = MatricesOver(terrain, parameters, now_s, since_list_s);
  const glm::dvec3 sun_ecef = SunDirectionEcef(parameters.UtcAt(now_s));
  const ViewBlock block = MakeViewBlock(parameters, view.matrices, sun_ecef, since_list_s);
  glNamedBufferData(view_block_.get(), sizeof(ViewBlock), &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, view_block_.get());

  view.target.Resize(parameters.width_px, parameters.height_px);
  view.target.Begin(parameters.sky ? std::nullopt : std::optional(parameters.background));
  Drawn drawn;
  if (view.has_terrain) {
    WalkList(terrain, view.matrices, view.visible);
    if (parameters.wireframe) glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    view.terrain.Draw(terrain, view.visible.terrain, view.matrices, parameters, since_list_s, sun_ecef);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    if (parameters.volumes) volumes_.Draw(terrain, view.matrices);
    drawn = {view.visible.triangles, static_cast<uint32_t>(view.visible.terrain.size())};
  }
  const bool has_objects = view.has_objects && parameters.draw_objects;
  if (how == Objects::kMoved) view.overlay.Clear();
  if (has_objects && how == Objects::kMoved) {
    WalkList(objects, view.matrices, view.visible_objects);
    const std::vector<MovedObject> moved =
        MoveObjects(objects, view.visible_objects.instances, parameters, view.matrices, now_s);
    const double since_objects_s = std::clamp(now_s - objects.time_s, 0.0, kLongestExtrapolation_s);
    objects_.Place(objects, moved, parameters, view.matrices, sun_ecef, since_objects_s);
    AddObjectOverlay(objects, moved, parameters, view.matrices, view.overlay);
  }
  if (has_objects) drawn.triangles += objects_.Draw();
  if (parameters.sky) sky_.Draw();
  if (has_objects) {
    effects_.Draw(objects, parameters, view.matrices, sun_ecef,
                  std::clamp(now_s - objects.time_s, 0.0, kLongestExtrapolation_s));
  }
  if (how == Objects::kMoved) PlaceOverlay(view, parameters, now_s);
  overlay_.Draw();
  view.target.Resolve();
  return drawn;
}

void Renderer::PlaceOverlay(View& view, const ViewParameters& parameters, double now_s) {
  if (parameters.hud) {
    if (now_s - view.hud_s >= kHudRefresh_s) {
      view.hud_s = now_s;
      const DisplayList::Statistics& terrain = view.channel->terrain_lists.front().statistics;
      const Geodetic eye = ToGeodetic(view.matrices.eye_ecef);
      HudFacts facts;
      facts.frame_ms = view.report.frame_ms;
      facts.draw_ms = view.report.draw_ms;
      facts.error_asked_px = parameters.error_px;
      facts.error_held_px = terrain.held_error_px;
      facts.error_achieved_px = terrain.achieved_error_px;
      facts.pages_waiting = terrain.pages_waiting;
      facts.uploads_pending = view.uploads_pending;
      facts.triangles = view.report.triangles;
      facts.nodes = view.report.nodes;
      facts.has_terrain = view.has_terrain;
      facts.latitude_deg = eye.latitude_deg;
      facts.longitude_deg = eye.longitude_deg;
      facts.height_m = eye.height_m;
      facts.height_above_ground_m = terrain.height_above_ground_m;
      if (parameters.pages) facts.layer_pages = view.channel->terrain_lists.front().layer_pages;
      facts.notices = notices_;
      view.hud.Clear();
      AddHud(HudTextOf(facts), view.hud);
    }
    view.overlay.Append(view.hud);
  }
  overlay_.Place(view.overlay);
}

bool Renderer::IsSettled(const View& view, const ViewParameters& parameters, double clock_now_s) {
  const DisplayList& terrain = view.channel->terrain_lists.front();
  return view.has_terrain && terrain.statistics.settled && terrain.view_number == parameters.number &&
         clock_now_s >= terrain.statistics.rises_until_s;
}

void Renderer::Report(View& view, double frame_ms, double draw_ms, const Drawn& drawn, FrameRecorder& recorder) {
  const DisplayList& terrain = view.channel->terrain_lists.front();
  FrameReport& report = view.report;
  ++report.frame;
  report.terrain_list = view.has_terrain ? terrain.number : 0;
  report.object_list = view.has_objects ? view.channel->object_lists.front().number : 0;
  report.draw_ms = draw_ms;
  report.frame_ms = frame_ms;
  report.busy_ms = busy_ms_;
  report.triangles = drawn.triangles;
  report.nodes = drawn.nodes;
  report.uploads_pending = view.uploads_pending;
  report.behind = view.has_terrain && terrain.statistics.behind;
  report.view_number = view.parameters->number;
  report.settled = IsSettled(view, *view.parameters, start_s_);
  view.channel->frame.Publish(report);

  FrameSample sample;
  sample.view = view.id;
  sample.frame = frame_;
  sample.time_s = start_s_;
  sample.frame_ms = frame_ms;
  sample.draw_ms = draw_ms;
  sample.triangles = drawn.triangles;
  sample.nodes = drawn.nodes;
  sample.held_error_px = terrain.statistics.held_error_px;
  sample.achieved_error_px = terrain.statistics.achieved_error_px;
  sample.behind = report.behind;
  sample.has_terrain = view.has_terrain;
  if (view.has_objects) {
    const DisplayList& objects = view.channel->object_lists.front();
    sample.objects_ms = objects.statistics.build_ms;
    sample.instances = static_cast<uint32_t>(objects.instances.size());
  }
  sample.upload_ms = upload_ms_;
  sample.upload_bytes = upload_bytes_;
  recorder.Add(sample);
}

Result<Picture> Renderer::Capture(ViewId id, Moment moment) {
  View* view = Find(id);
  if (view == nullptr) return Status::Error("capture: there is no view {}", id);
  const auto newest = view->channel->parameters.Get();
  const bool of_parameters = moment == Moment::kOfParameters || !view->parameters;
  const ViewParameters& parameters = of_parameters ? *newest : *view->parameters;
  if (parameters.width_px <= 0 || parameters.height_px <= 0) {
    return Status::Error("capture: view {} has no pixels; give it a size", id);
  }
  const double now_s = of_parameters ? clock_.NowSeconds() : view->drawn_s;
  const Drawn drawn = DrawView(*view, parameters, of_parameters ? parameters.time_s : view->drawn_s, now_s);
  return ReadBack(*view, parameters, drawn, now_s);
}

Picture Renderer::ReadBack(const View& view, const ViewParameters& parameters, const Drawn& drawn,
                           double clock_now_s) const {
  const DisplayList& terrain = view.channel->terrain_lists.front();
  Picture picture;
  picture.width_px = view.target.width();
  picture.height_px = view.target.height();
  picture.rgb = view.target.ReadRgb();
  picture.depth_m = view.target.ReadDepth();
  for (float& depth : picture.depth_m) {
    depth = AxisDistance(view.matrices.clip_from_camera, parameters.projection, depth);
  }
  picture.matrices = view.matrices;
  picture.view_number = parameters.number;
  picture.terrain_list = view.has_terrain ? terrain.number : 0;
  picture.object_list = view.has_objects ? view.channel->object_lists.front().number : 0;
  picture.triangles = drawn.triangles;
  picture.nodes = drawn.nodes;
  picture.achieved_error_px = terrain.statistics.achieved_error_px;
  picture.settled = IsSettled(view, parameters, clock_now_s);
  return picture;
}

std::vector<double> Renderer::Redraw(ViewId id, int times, bool still) {
  std::vector<double> draw_ms;
  View* view = Find(id);
  if (view == nullptr || !view->parameters) return draw_ms;
  // Another view may have placed its objects since.
  if (still) DrawView(*view, *view->parameters, view->drawn_s, view->drawn_s);
  for (int i = 0; i < times; ++i) {
    const double start_s = clock_.NowSeconds();
    DrawView(*view, *view->parameters, view->drawn_s, view->drawn_s, still ? Objects::kStill : Objects::kMoved);
    in_flight_.EndFrame();
    draw_ms.push_back((clock_.NowSeconds() - start_s) * 1000);
  }
  last_start_s_.reset();  // the next frame was not this late
  return draw_ms;
}

}  // namespace belvedere

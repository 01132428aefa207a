#include "managers/terrain_manager.h"

#include "managers/cut.h"
#include "managers/eye_jump.h"
#include "managers/foresight.h"
#include "managers/held_bound.h"
#include "managers/image_fade.h"
#include "managers/list_pages.h"
#include "managers/paced_thread.h"
#include "managers/step_change.h"
#include "managers/surface_mesh.h"
#include "runtime/base/status.h"
#include "runtime/base/trace.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/terrain_height.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace belvedere {
namespace {

constexpr double kListsPerSecond = 34.0;
constexpr double kPinnedShareOfBudget = 0.8;  // of the cache; over it, cuts stop growing
constexpr double kShareOfSlots = 0.8;         // for images of one list; the ones before it hold others for a moment
constexpr double kRateSmoothing = 0.1;

}  // namespace

class TerrainManager::Worker {
 public:
  Worker(ViewId view, Paging& paging, std::shared_ptr<ViewChannel> channel, ImageLimits slots, const Clock& clock)
      : view_id_(view),
        paging_(paging),
        channel_(std::move(channel)),
        clock_(clock),
        image_limits_{static_cast<int>(kShareOfSlots * slots.colour), static_cast<int>(kShareOfSlots * slots.overlay)},
        terrain_(TerrainType(paging.layers)),
        thread_("terrain manager", kListsPerSecond, [this] { Step(); }) {}

  double scene_hz() const { return scene_hz_.load(); }

 private:
  static DataType TerrainType(const LayerTable& layers) {
    const Layer* terrain = layers.FirstOf(PageKind::kTerrain);
    BELVEDERE_CHECK(terrain != nullptr);
    return terrain->type;
  }

  void Step() {
    const GatePass pass(paging_.listing);
    const std::shared_ptr<const ViewParameters> view = channel_->parameters.Get();
    const double now_s = clock_.NowSeconds();
    if (view->number == 0 || IsUpToDate(*view, now_s)) return;
    generation_ = paging_.generation.load(std::memory_order_acquire);
    const TraceSpan span("terrain.list");
    DisplayList& list = channel_->terrain_lists.back();
    list.Clear();
    Build(*view, now_s, list);
    list.statistics.build_ms = (clock_.NowSeconds() - now_s) * 1e3;
    settled_number_ = list.statistics.settled ? view->number : 0;
    channel_->terrain_lists.Publish();
    if (last_list_s_ > 0 && now_s > last_list_s_) {
      const double rate = 1.0 / (now_s - last_list_s_);
      scene_hz_ = scene_hz_ + kRateSmoothing * (rate - scene_hz_);
    }
    last_list_s_ = now_s;
  }

  // Nothing would change: the same settled view, with an eye that stands still, and no next step of a layer.
  bool IsUpToDate(const ViewParameters& view, double now_s) const {
    if (view.frozen && number_ > 0) return true;
    return generation_ == paging_.generation.load(std::memory_order_acquire) && view.number == settled_number_ &&
           view.eye_velocity_mps == glm::dvec3(0) &&
           !steps_.IsDue(view.image_layers, paging_.layers, view.UtcAt(now_s));
  }

  void Build(const ViewParameters& view, double now_s, DisplayList& list) {
    const Geodetic eye = ToGeodetic(view.EyeAt(now_s));
    const std::optional<GroundPoint> ground = GroundUnder(paging_, terrain_, eye.latitude_deg, eye.longitude_deg);
    const double height_m = std::max(0.0, eye.height_m - (ground ? ground->height_m : 0.0));
    const ViewMatrices matrices = MatricesOf(view, now_s, height_m);
    const bool jump = jump_.Next(view, now_s, height_m, was_settled_);

    ViewParameters held = view;
    held.error_px = bound_.Next(view, *channel_->frame.Get(), number_ + 1);
    held.image_layers = steps_.Next(view.image_layers, paging_.layers, view.UtcAt(now_s), now_s, jump);
    ListPages pages(paging_, terrain_, list, LimitsOfImages());
    const bool is_full = CacheIsFull();
    CutLimits limits;
    if (is_full) limits.max_nodes = std::min(limits.max_nodes, last_nodes_);
    Cut cut = SelectCut(held, matrices, paging_.layers, terrain_, limits, pages, steps_.before());
    steps_.Shown(cut.of_step_before, now_s);
    fade_.Apply(cut.nodes, view.image_layers, now_s, jump, pages);
    surface_.morph.Begin(now_s, jump);
    list.time_s = now_s;
    const MeshStatistics mesh =
        BuildSurface(cut.nodes, SightOf(view, matrices.eye_ecef), held.error_px, surface_, list);
    last_nodes_ = static_cast<int>(cut.nodes.size());
    if (!is_full && pages.pages_waiting() == 0) {
      Foresee(held, now_s, height_m, paging_.layers, terrain_, limits, pages);
    }
    if (view.pages) pages.CountByLayer();
    pages.Finish(view_id_, ListPages::Queues::kTerrain);

    list.view = view_id_;
    list.view_number = view.number;
    list.number = ++number_;
    list.statistics.height_above_ground_m = height_m;
    list.statistics.held_error_px = held.error_px;
    Describe(cut, mesh, pages, list.statistics);
    list.records = std::move(cut.records);
    list.volumes = std::move(cut.volumes);
  }

  // Images of a layer's step before are shown beside those of its next.
  ImageLimits LimitsOfImages() const {
    ImageLimits limits = image_limits_;
    limits.colour -= steps_.images_before();
    return limits;
  }

  bool CacheIsFull() const {
    return static_cast<double>(paging_.cache.PinnedBytes()) >
           kPinnedShareOfBudget * static_cast<double>(paging_.cache.budget_bytes());
  }

  void Describe(const Cut& cut, const MeshStatistics& mesh, const ListPages& pages,
                DisplayList::Statistics& statistics) {
    statistics.triangles = mesh.triangles;
    statistics.nodes = static_cast<uint32_t>(cut.nodes.size());
    statistics.achieved_error_px = mesh.achieved_error_px + cut.left_over_error_px;
    statistics.pages_waiting = static_cast<uint32_t>(pages.pages_waiting());
    statistics.behind = cut.behind || pages.at_limit();
    statistics.rises_until_s = std::max(mesh.rises_until_s, fade_.until_s());
    statistics.settled =
        !cut.waiting && pages.pages_waiting() == 0 && !cut.nodes.empty() && !steps_.changing() && !fade_.waits();
    was_settled_ = statistics.settled;
  }

  const ViewId view_id_;
  Paging& paging_;
  const std::shared_ptr<ViewChannel> channel_;
  const Clock& clock_;
  const ImageLimits image_limits_;
  const DataType terrain_;
  uint64_t number_ = 0;
  uint64_t settled_number_ = 0;
  uint64_t generation_ = 0;  // of the pages of the last list
  int last_nodes_ = 0;
  bool was_settled_ = false;
  SurfaceState surface_;
  ImageFade fade_;
  StepChange steps_;
  EyeJump jump_;
  HeldBound bound_;
  double last_list_s_ = 0;
  std::atomic<double> scene_hz_{0};
  PacedThread thread_;  // last: it stops before the members above go
};

TerrainManager::TerrainManager(ViewId view, Paging& paging, std::shared_ptr<ViewChannel> channel, ImageLimits slots,
                               const Clock& clock)
    : worker_(std::make_unique<Worker>(view, paging, std::move(channel), slots, clock)), view_(view), paging_(paging) {}

TerrainManager::~TerrainManager() {
  worker_.reset();
  for (const Layer& layer : paging_.layers.layers()) {
    if (layer.kind != PageKind::kModel) paging_.queue(layer.type).SetWishes(view_, {});
  }
}

double TerrainManager::scene_hz() const {
  return worker_->scene_hz();
}

}  // namespace belvedere

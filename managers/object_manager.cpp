#include "managers/object_manager.h"

#include "managers/list_pages.h"
#include "managers/object_selection.h"
#include "managers/paced_thread.h"
#include "runtime/base/status.h"
#include "runtime/base/trace.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/model_catalogue.h"
#include "runtime/paging/terrain_height.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <unordered_map>

namespace belvedere {
namespace {

constexpr double kListsPerSecond = 20.0;
constexpr double kTypicalRadius_m = 10.0;  // of an object whose model is not in memory
constexpr int kGroupLevel = 3;             // objects are grouped for culling by their quadnode of this level
constexpr double kGroupLookAhead_s = 0.5;  // a group's volume holds where its objects will be until the next list

struct Candidate {
  ObjectInstance instance;
  Quadcode group;
};

}  // namespace

class ObjectManager::Worker {
 public:
  Worker(ViewId view, Paging& paging, const EntityLooks& looks, const ObjectTable& objects,
         std::shared_ptr<ViewChannel> channel, const Clock& clock)
      : view_id_(view),
        paging_(paging),
        looks_(looks),
        objects_(objects),
        channel_(std::move(channel)),
        clock_(clock),
        terrain_(paging.layers.FirstOf(PageKind::kTerrain)),
        models_(paging.layers.FirstOf(PageKind::kModel)),
        thread_("object manager", kListsPerSecond, [this] { Step(); }) {}

 private:
  void Step() {
    const std::shared_ptr<const ViewParameters> view = channel_->parameters.Get();
    if (view->number == 0) return;
    // Without objects the list that says so is enough.
    const bool none = objects_.Snapshot()->objects.empty() || !view->draw_objects;
    if (none && published_none_) return;
    published_none_ = none;
    const TraceSpan span("objects.list");
    const double now_s = clock_.NowSeconds();
    DisplayList& list = channel_->object_lists.back();
    list.Clear();
    list.labels.emplace_back();
    list.view = view_id_;
    list.view_number = view->number;
    list.number = ++number_;
    list.time_s = now_s;
    ListPages pages(paging_, terrain_ != nullptr ? terrain_->type : DataType{0}, list);
    if (view->draw_objects) Build(*view, now_s, pages, list);
    pages.Finish(view_id_, ListPages::Queues::kObjects);
    list.statistics.pages_waiting = static_cast<uint32_t>(pages.pages_waiting());
    list.statistics.settled = pages.pages_waiting() == 0;
    list.statistics.build_ms = (clock_.NowSeconds() - now_s) * 1e3;
    channel_->object_lists.Publish();
  }

  void Build(const ViewParameters& view, double now_s, ListPages& pages, DisplayList& list) {
    const Geodetic eye = ToGeodetic(view.EyeAt(now_s));
    const ViewMatrices matrices = MatricesOf(view, now_s, std::max(0.0, eye.height_m));
    const std::shared_ptr<const ObjectSnapshot> snapshot = objects_.Snapshot();
    std::vector<Candidate> candidates;
    std::unordered_map<EntityId, Smoother> still_shown;
    for (const ObjectRecord& record : snapshot->objects) {
      if (record.visible()) Consider(record, view, matrices, now_s, pages, list, still_shown, candidates);
    }
    smoothers_.swap(still_shown);
    Emit(candidates, list);
  }

  void Consider(const ObjectRecord& record, const ViewParameters& view, const ViewMatrices& matrices, double now_s,
                ListPages& pages, DisplayList& list, std::unordered_map<EntityId, Smoother>& still_shown,
                std::vector<Candidate>& candidates) {
    const EntityLook look = looks_.LookOf(record.type);
    const PageKey model_key = ModelKey(look.model);
    const auto* model =
        models_ != nullptr && look.model >= 0 ? static_cast<const ModelPage*>(pages.Find(model_key)) : nullptr;
    const double radius_m = model != nullptr ? model->radius_m : kTypicalRadius_m;
    const glm::dvec3 expected = PoseAt(record.kinematics, now_s).position_ecef;
    const ObjectShow show = HowToShow(view, matrices, expected, radius_m, look.model >= 0);
    if (show.how == ObjectShow::How::kNot) return;

    Pose pose = Smoothed(record, now_s, still_shown);
    const Geodetic position = ToGeodetic(pose.position_ecef);
    if (record.type.is_ground_platform() && terrain_ != nullptr) pose = Stand(pose, position);

    Candidate candidate;
    ObjectInstance& instance = candidate.instance;
    instance.position_ecef = pose.position_ecef;
    instance.velocity_mps = pose.velocity_ecef_mps;
    instance.ecef_from_body = pose.ecef_from_body;
    if (ModelRotates(record.kinematics.model))
      instance.angular_velocity_body = record.kinematics.angular_velocity_radps;
    instance.radius_m = radius_m;
    instance.look.colour = ForceColour(record.force);
    instance.look.symbol = static_cast<uint8_t>(look.symbol);
    instance.object = static_cast<uint64_t>(record.id.site) << 32 | static_cast<uint64_t>(record.id.application) << 16 |
                      record.id.entity;
    if (show.how == ObjectShow::How::kModel) ChooseModel(model, model_key, show, pages, instance);
    if (view.labels) {
      instance.label = static_cast<uint32_t>(list.labels.size());
      list.labels.push_back(LabelText(record, position.height_m));
    }
    candidate.group = Quadcode::Containing(position.latitude_deg, position.longitude_deg, kGroupLevel);
    candidates.push_back(candidate);
  }

  PageKey ModelKey(int model) const {
    if (models_ == nullptr || model < 0) return {};
    return {models_->type, ModelCatalogue::ModelNode(model)};
  }

  static void ChooseModel(const ModelPage* model, const PageKey& key, const ObjectShow& show, ListPages& pages,
                          ObjectInstance& instance) {
    const std::optional<int> slot = model != nullptr ? pages.Slot(key) : std::nullopt;
    if (!slot) {
      pages.Want(key, static_cast<float>(show.size_px));
      return;  // a symbol until the model is there
    }
    instance.look.model_slot = *slot;
    instance.look.detail = ChooseDetail(*model, show.metre_px);
    instance.look.symbol = static_cast<uint8_t>(SymbolShape::kNone);
  }

  Pose Smoothed(const ObjectRecord& record, double now_s, std::unordered_map<EntityId, Smoother>& still_shown) {
    auto known = smoothers_.extract(record.id);
    const auto place =
        known.empty() ? still_shown.try_emplace(record.id).first : still_shown.insert(std::move(known)).position;
    return place->second.Show(record.kinematics, record.report, now_s);
  }

  Pose Stand(const Pose& pose, const Geodetic& position) const {
    const std::optional<GroundPoint> ground =
        GroundUnder(paging_, terrain_->type, position.latitude_deg, position.longitude_deg);
    return ground ? StandOn(pose, ground->height_m, ground->normal_ecef) : pose;
  }

  // Instances, grouped by place; one culling volume a group.
  static void Emit(std::vector<Candidate>& candidates, DisplayList& list) {
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.group < b.group; });
    for (size_t begin = 0; begin < candidates.size();) {
      size_t end = begin;
      glm::dvec3 center(0.0);
      for (; end < candidates.size() && candidates[end].group == candidates[begin].group; ++end) {
        center += candidates[end].instance.position_ecef;
      }
      center /= static_cast<double>(end - begin);
      double radius = 0;
      const auto first = static_cast<uint32_t>(list.instances.size());
      for (size_t i = begin; i < end; ++i) {
        const ObjectInstance& instance = candidates[i].instance;
        radius = std::max(radius, glm::distance(center, instance.position_ecef) + instance.radius_m +
                                      kGroupLookAhead_s * glm::length(instance.velocity_mps));
        list.instances.push_back(instance);
      }
      const auto record = static_cast<uint32_t>(list.records.size());
      list.records.push_back({ListRecord::Kind::kCullBegin, static_cast<uint32_t>(list.volumes.size()), 0, record + 3});
      list.records.push_back({ListRecord::Kind::kDrawInstances, first, static_cast<uint32_t>(end - begin), 0});
      list.records.push_back({ListRecord::Kind::kCullEnd, 0, 0, 0});
      list.volumes.push_back({center, radius});
      begin = end;
    }
  }

  const ViewId view_id_;
  Paging& paging_;
  const EntityLooks& looks_;
  const ObjectTable& objects_;
  const std::shared_ptr<ViewChannel> channel_;
  const Clock& clock_;
  const Layer* const terrain_;
  const Layer* const models_;
  bool published_none_ = false;
  uint64_t number_ = 0;
  std::unordered_map<EntityId, Smoother> smoothers_;  // of the objects that the last list showed
  PacedThread thread_;                                // last: it stops before the members above go
};

ObjectManager::ObjectManager(ViewId view, Paging& paging, const EntityLooks& looks, const ObjectTable& objects,
                             std::shared_ptr<ViewChannel> channel, const Clock& clock)
    : worker_(std::make_unique<Worker>(view, paging, looks, objects, std::move(channel), clock)),
      view_(view),
      paging_(paging) {}

ObjectManager::~ObjectManager() {
  worker_.reset();
  for (const Layer& layer : paging_.layers.layers()) {
    if (layer.kind == PageKind::kModel) paging_.queue(layer.type).SetWishes(view_, {});
  }
}

}  // namespace belvedere

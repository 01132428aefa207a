#include "managers/object_manager.h"

#include "managers/attachments.h"
#include "managers/effects.h"
#include "managers/footing.h"
#include "managers/group_selection.h"
#include "managers/instance_groups.h"
#include "managers/joints.h"
#include "managers/label_layout.h"
#include "managers/list_pages.h"
#include "managers/object_selection.h"
#include "managers/paced_thread.h"
#include "managers/shown_objects.h"
#include "managers/watch_outline.h"
#include "runtime/base/status.h"
#include "runtime/base/trace.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/sun.h"
#include "runtime/paging/model_catalogue.h"
#include "runtime/paging/terrain_height.h"
#include "runtime/scene/label_format.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace belvedere {
namespace {

constexpr double kListsPerSecond = 20.0;
constexpr double kTypicalRadius_m = 10.0;  // of an object whose model is not in memory
constexpr double kCoarsestDetail_px = 64;
constexpr double kLeastAttached_px = 3;

uint64_t PackedType(const EntityType& type) {
  return uint64_t{type.kind} << 56 | uint64_t{type.domain} << 48 | uint64_t{type.country} << 32 |
         uint64_t{type.category} << 24 | uint64_t{type.subcategory} << 16 | uint64_t{type.specific} << 8 | type.extra;
}

}  // namespace

class ObjectManager::Worker {
 public:
  Worker(ViewId view, Paging& paging, const EntityLooks& looks, const ObjectTable& objects,
         const ClusterManager& clusters, std::shared_ptr<ViewChannel> channel, const Clock& clock)
      : view_id_(view),
        paging_(paging),
        looks_(looks),
        objects_(objects),
        clusters_(clusters),
        channel_(std::move(channel)),
        clock_(clock),
        terrain_(paging.layers.FirstOf(PageKind::kTerrain)),
        models_(paging.layers.FirstOf(PageKind::kModel)),
        thread_("object manager", kListsPerSecond, [this] { Step(); }) {}

 private:
  void Step() {
    const std::shared_ptr<const ViewParameters> view = channel_->parameters.Get();
    if (view->number == 0) return;
    const auto snapshot = objects_.Snapshot();
    const double now_s = clock_.NowSeconds();
    if (!IsNews(*view, *snapshot, now_s)) return;
    const TraceSpan span("objects.list");
    DisplayList& list = channel_->object_lists.back();
    list.Clear();
    list.labels.emplace_back();
    list.view = view_id_;
    list.view_number = view->number;
    list.number = ++number_;
    list.time_s = now_s;
    ListPages pages(paging_, terrain_ != nullptr ? terrain_->type : DataType{0}, list);
    if (view->draw_objects) Build(*view, *snapshot, now_s, pages, list);
    AddOutlines(*view, now_s, list);
    pages.Finish(view_id_, ListPages::Queues::kObjects);
    list.statistics.pages_waiting = static_cast<uint32_t>(pages.pages_waiting());
    list.statistics.settled = pages.pages_waiting() == 0;
    list.statistics.build_ms = (clock_.NowSeconds() - now_s) * 1e3;
    channel_->object_lists.Publish();
  }

  // Without objects one list that says so is enough, until outlines of watch areas are others, are seen from elsewhere,
  // or may lie on finer ground.
  bool IsNews(const ViewParameters& view, const ObjectSnapshot& snapshot, double now_s) {
    const bool none = (snapshot.objects.empty() && snapshot.events.empty()) || !view.draw_objects;
    const bool moved = view.watched != nullptr && view.number != listed_view_;
    const bool is_news = !none || !listed_none_ || moved || outlines_.AreDue(view.watched, now_s);
    listed_none_ = none;
    listed_view_ = view.number;
    return is_news;
  }

  void Build(const ViewParameters& view, const ObjectSnapshot& snapshot, double now_s, ListPages& pages,
             DisplayList& list) {
    const Geodetic eye = ToGeodetic(view.EyeAt(now_s));
    const ViewMatrices matrices = MatricesOf(view, now_s, std::max(0.0, eye.height_m));
    Clear();
    const std::shared_ptr<const ClusterTree> tree = view.groups ? clusters_.tree() : std::make_shared<ClusterTree>();
    groups_.Select(*tree, view, matrices, now_s);
    for (const ObjectRecord& record : snapshot.objects) {
      if (!record.visible()) continue;
      const GroupSelection::State state = groups_.StateOf(tree->LeafOf(record.slot, record.incarnation));
      if (state == GroupSelection::State::kOpen) Consider(record, view, matrices, now_s, pages);
    }
    for (const Cluster* group : groups_.groups()) AddGroup(*group, view, matrices, now_s - tree->time_s);
    KeepTriangleBudget();
    AddEffects(view, snapshot.events, now_s, list);
    if (view.labels) AddLabels(view, list);
    placed_.Emit(instances_, list);
    shown_.ForgetOthers(number_);
  }

  void Clear() {
    instances_.clear();
    placed_.Clear();
    drawn_models_.clear();
    effect_wishes_.clear();
    wishes_.clear();
    wishers_.clear();
    models_found_.clear();
  }

  void Consider(const ObjectRecord& record, const ViewParameters& view, const ViewMatrices& matrices, double now_s,
                ListPages& pages) {
    if (!MayBeSeen(matrices, record.kinematics, kTypicalRadius_m, now_s)) return;
    const EntityLook& look = LookOf(record.type);
    const ModelPage* model = ModelOf(look.model, pages);
    const double radius_m = model != nullptr ? model->radius_m : kTypicalRadius_m;
    const Pose path = PoseAt(record.kinematics, now_s);
    const ObjectShow show = HowToShow(view, matrices, path.position_ecef, radius_m, look.model >= 0);
    if (show.how == ObjectShow::How::kNot) return;

    ShownObject& shown = shown_.Show(record, number_);
    Pose pose = shown.smoother.Show(record.kinematics, path, record.report, now_s);
    pose = Stand(pose, FootingOf(record.type), view, shown, now_s);

    ObjectInstance& instance = instances_.emplace_back();
    instance.position_ecef = pose.position_ecef;
    instance.velocity_mps = pose.velocity_ecef_mps;
    instance.ecef_from_body = pose.ecef_from_body;
    if (ModelRotates(record.kinematics.model))
      instance.angular_velocity_body = record.kinematics.angular_velocity_radps;
    const Posture posture = PostureOf(record, instance.ecef_from_body);
    instance.position_ecef += posture.lowered_m * instance.ecef_from_body[2];
    instance.ecef_from_body = posture.ecef_from_body;
    if (show.how == ObjectShow::How::kModel) {
      const JointsOf joints = JointsAt(record, now_s);
      instance.joints = joints.pose;
      instance.spin_radps = joints.spin_radps;
    }
    instance.radius_m = radius_m;
    instance.look.colour = ForceColour(record.force);
    instance.look.symbol = static_cast<uint8_t>(look.symbol);
    instance.object = static_cast<uint64_t>(record.id.site) << 32 | static_cast<uint64_t>(record.id.application) << 16 |
                      record.id.entity;
    if (show.how == ObjectShow::How::kModel) ChooseModel(model, ModelKey(look.model), show, pages, instance);
    const auto index = static_cast<uint32_t>(instances_.size() - 1);
    placed_.Add(index, instance.position_ecef);
    instance.look.shade = ShadeOfDamage(record.damage());
    WishEffects(record, shown, view, matrices, index, now_s);
    if (view.frames) instance.look.frame = static_cast<uint8_t>(ForceFrame(record.force));
    if (view.labels) WishLabel({&record, &look, index, 1}, FormatOf(view).SizeFor(record), &shown, view, matrices);
    if (instances_[index].look.model_slot >= 0) Attach(record, *model, show.metre_px, pages, index);
  }

  // What hangs on an object, each at its station of the model.
  void Attach(const ObjectRecord& record, const ModelPage& carrier, double metre_px, ListPages& pages, uint32_t index) {
    for (const AttachedPart& part : record.attached()) {
      const std::optional<glm::vec3> place = PlaceOfStation(carrier, part.station);
      const int number = LookOf(part.type).model;
      if (!place || number < 0) continue;
      const ModelPage* model = ModelOf(number, pages);
      const double radius_m = model != nullptr ? model->radius_m : kTypicalRadius_m;
      const double size_px = 2 * radius_m * metre_px;
      if (size_px < kLeastAttached_px) continue;
      ObjectInstance hanging = instances_[index];
      const glm::dvec3 arm(*place);
      hanging.position_ecef += hanging.ecef_from_body * arm;
      hanging.velocity_mps += hanging.ecef_from_body * glm::cross(hanging.angular_velocity_body, arm);
      hanging.joints = {};
      hanging.spin_radps = 0;
      hanging.label = 0;
      hanging.radius_m = radius_m;
      hanging.look.model_slot = -1;
      instances_.push_back(hanging);
      ChooseModel(model, ModelKey(number), {ObjectShow::How::kModel, size_px, metre_px}, pages, instances_.back());
      if (instances_.back().look.model_slot < 0) {
        instances_.pop_back();  // until its model is there
      } else {
        placed_.Add(static_cast<uint32_t>(instances_.size() - 1), hanging.position_ecef);
      }
    }
  }

  // Coarser models, all by the same error on the screen, until they have no more triangles than a view may have.
  void KeepTriangleBudget() {
    for (double error_px = 2; error_px <= kCoarsestDetail_px; error_px *= 2) {
      uint64_t triangles = 0;
      for (const DrawnModel& drawn : drawn_models_) {
        triangles += drawn.model->details[instances_[drawn.instance].look.detail].index_count / 3;
      }
      if (triangles <= kMostObjectTriangles) return;
      for (const DrawnModel& drawn : drawn_models_) {
        instances_[drawn.instance].look.detail = ChooseDetail(*drawn.model, drawn.metre_px, error_px);
      }
    }
  }

  // One symbol for all of a cluster, with their number.
  void AddGroup(const Cluster& group, const ViewParameters& view, const ViewMatrices& matrices, double since_s) {
    const EntityLook& look = LookOf({group.key.kind, group.key.domain, 0, 0, 0, 0, 0});
    ObjectInstance& instance = instances_.emplace_back();
    instance.position_ecef = group.centre_ecef + since_s * group.velocity_mps;
    instance.velocity_mps = group.velocity_mps;
    const glm::dvec3 up = glm::normalize(instance.position_ecef);
    const glm::dvec3 ahead = group.velocity_mps - glm::dot(group.velocity_mps, up) * up;
    if (glm::length(ahead) > kStationary_mps) {
      const glm::dvec3 forward = glm::normalize(ahead);
      instance.ecef_from_body = glm::dmat3(forward, glm::cross(-up, forward), -up);
    }
    instance.radius_m = kTypicalRadius_m;
    instance.look.colour = ForceColour(group.key.force);
    instance.look.symbol = static_cast<uint8_t>(look.symbol);
    instance.look.frame = static_cast<uint8_t>(ForceFrame(group.key.force));
    const auto index = static_cast<uint32_t>(instances_.size() - 1);
    placed_.Add(index, instance.position_ecef);
    if (view.labels)
      WishLabel({nullptr, &look, index, group.members}, SizeOf(GroupText(group.members)), nullptr, view, matrices);
  }

  static std::string GroupText(uint32_t members) { return fmt::format("\u00d7{}", members); }

  const EntityLook& LookOf(const EntityType& type) {
    constexpr size_t kMostTypes = 4096;
    if (known_looks_.size() >= kMostTypes) known_looks_.clear();
    const EntityLook*& look = known_looks_[PackedType(type)];
    if (look == nullptr) look = &looks_.LookOf(type);
    return *look;
  }

  // The model's page, looked for once a list; nullptr while it is not in memory.
  const ModelPage* ModelOf(int model, ListPages& pages) {
    if (models_ == nullptr || model < 0) return nullptr;
    const auto index = static_cast<size_t>(model);
    if (index >= models_found_.size()) models_found_.resize(index + 1);
    auto& found = models_found_[index];
    if (!found) found = static_cast<const ModelPage*>(pages.Find(ModelKey(model)));
    return *found;
  }

  struct DrawnModel {
    uint32_t instance;
    const ModelPage* model;
    double metre_px;
  };

  // ---- effects

  struct EffectWish {
    double distance_m;
    const ObjectRecord* record;
    uint32_t instance;
    SeenAppearance seen;
  };

  void WishEffects(const ObjectRecord& record, ShownObject& shown, const ViewParameters& view,
                   const ViewMatrices& matrices, uint32_t index, double now_s) {
    const ObjectInstance& instance = instances_[index];
    if (view.trails_s > 0) {
      const double every_s = view.trails_s / (kMostTrackPoints - 2);
      if (shown.track.empty() || now_s - shown.track.back().time_s >= every_s) {
        if (shown.track.size() == kMostTrackPoints) shown.track.erase(shown.track.begin());
        shown.track.push_back({instance.position_ecef, now_s});
      }
    } else {
      shown.track.clear();
    }
    const SeenAppearance seen = view.effects ? AppearanceOf(record.type, record.appearance) : SeenAppearance{};
    if (!seen.any() && view.trails_s <= 0 && view.vectors_s <= 0) return;
    effect_wishes_.push_back({glm::distance(instance.position_ecef, matrices.eye_ecef), &record, index, seen});
  }

  // Events, then what belongs to objects, nearest first, as long as there is room.
  void AddEffects(const ViewParameters& view, std::span<const SceneEvent> events, double now_s, DisplayList& list) {
    constexpr size_t kMostOfOne = 128;  // that one event or object adds
    if (view.effects) {
      for (size_t i = events.size(); i-- > 0 && list.effects.size() + kMostOfOne < kMostEffects;) {
        AddEvent(events[i], now_s, GroundOf(events[i]), list.effects);
      }
    }
    std::sort(effect_wishes_.begin(), effect_wishes_.end(),
              [](const EffectWish& a, const EffectWish& b) { return a.distance_m < b.distance_m; });
    const glm::dvec3 sun_ecef = SunDirectionEcef(view.UtcAt(now_s));
    for (const EffectWish& wish : effect_wishes_) {
      if (list.effects.size() + kMostOfOne > kMostEffects) break;
      const ObjectInstance& object = instances_[wish.instance];
      const double sun_sine = glm::dot(glm::normalize(object.position_ecef), sun_ecef);
      const EffectMoment moment{now_s, std::clamp((sun_sine + 0.10) / 0.25, 0.0, 1.0)};
      const ShownObject* shown = shown_.Find(wish.record->slot);
      AddAppearance(wish.seen, wish.record->type, object, object.object, moment, list.effects);
      if (view.trails_s > 0) AddTrail(shown->track, object, now_s, view.trails_s, list.effects);
      if (view.vectors_s > 0) AddVector(wish.record->kinematics, object, now_s, view.vectors_s, list.effects);
    }
  }

  void AddOutlines(const ViewParameters& view, double now_s, DisplayList& list) {
    const GroundHeight ground = [&](double latitude_deg, double longitude_deg) {
      if (terrain_ == nullptr) return 0.0;
      const auto under = GroundUnder(paging_, terrain_->type, latitude_deg, longitude_deg);
      return under ? under->height_m : 0.0;
    };
    outlines_.Add(view.watched, view.EyeAt(now_s), now_s, ground, list.effects);
  }

  std::optional<EffectGround> GroundOf(const SceneEvent& event) const {
    if (event.kind != SceneEvent::Kind::kScorch || terrain_ == nullptr) return std::nullopt;
    const Geodetic place = ToGeodetic(event.position_ecef);
    const auto ground = GroundUnder(paging_, terrain_->type, place.latitude_deg, place.longitude_deg);
    if (!ground) return std::nullopt;
    return EffectGround{ground->height_m, ground->normal_ecef};
  }

  // ---- labels

  struct Wisher {
    const ObjectRecord* record;  // nullptr: a group
    const EntityLook* look;
    uint32_t instance;
    uint32_t members;
  };

  // shown: what is remembered of the object; nullptr for a group, whose label is as good as shown before.
  void WishLabel(const Wisher& wisher, LabelSize size, const ShownObject* shown, const ViewParameters& view,
                 const ViewMatrices& matrices) {
    const ObjectInstance& instance = instances_[wisher.instance];
    const glm::dvec4 camera = matrices.camera_from_ecef * glm::dvec4(instance.position_ecef, 1.0);
    const glm::dvec4 clip = matrices.clip_from_camera * camera;
    if (clip.w <= 0 || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) return;
    const double metre_px = view.projection == Projection::kPerspective
                                ? matrices.pixels_per_radian / std::max(-camera.z, matrices.near_m)
                                : matrices.pixels_per_metre;
    LabelWish wish;
    wish.anchor_px = {static_cast<float>((0.5 + 0.5 * clip.x / clip.w) * view.width_px),
                      static_cast<float>((0.5 - 0.5 * clip.y / clip.w) * view.height_px)};
    wish.beside_px = BesideLabel(instance.look.model_slot >= 0 && !view.symbols, metre_px * instance.radius_m);
    wish.distance_m = static_cast<float>(-camera.z);
    wish.size = size;
    wish.shown_before = shown == nullptr || shown->labelled;
    wish.side_before = shown == nullptr ? LabelSide::kRight : shown->label_side;
    wishes_.push_back(wish);
    wishers_.push_back(wisher);
  }

  const LabelFormat& FormatOf(const ViewParameters& view) const {
    return view.label_format != nullptr ? *view.label_format : usual_format_;
  }

  void AddLabels(const ViewParameters& view, DisplayList& list) {
    for (const Wisher& wisher : wishers_) {
      if (wisher.record != nullptr) shown_.Find(wisher.record->slot)->labelled = false;
    }
    for (const LabelPlace& place : layout_.Lay(wishes_, view.width_px, view.height_px)) {
      const Wisher& wisher = wishers_[place.wish];
      ObjectInstance& instance = instances_[wisher.instance];
      instance.label = static_cast<uint32_t>(list.labels.size());
      if (wisher.record == nullptr) {
        list.labels.push_back({GroupText(wisher.members), place.side});
        continue;
      }
      ShownObject& shown = *shown_.Find(wisher.record->slot);
      shown.labelled = true;
      shown.label_side = place.side;
      const Geodetic at = ToGeodetic(instance.position_ecef);
      const LabelFacts facts{*wisher.record,   wisher.look->name, at.latitude_deg,
                             at.longitude_deg, at.height_m,       instance.velocity_mps};
      list.labels.push_back({FormatOf(view).Write(facts), place.side});
    }
  }

  PageKey ModelKey(int model) const {
    if (models_ == nullptr || model < 0) return {};
    return {models_->type, ModelCatalogue::ModelNode(model)};
  }

  void ChooseModel(const ModelPage* model, const PageKey& key, const ObjectShow& show, ListPages& pages,
                   ObjectInstance& instance) {
    const std::optional<int> slot = model != nullptr ? pages.Slot(key) : std::nullopt;
    if (!slot) {
      pages.Want(key, static_cast<float>(show.size_px));
      return;  // a symbol until the model is there
    }
    instance.look.model_slot = *slot;
    instance.look.detail = ChooseDetail(*model, show.metre_px);
    drawn_models_.push_back({static_cast<uint32_t>(instances_.size() - 1), model, show.metre_px});
    instance.look.symbol = static_cast<uint8_t>(SymbolShape::kNone);
  }

  Pose Stand(const Pose& pose, Footing footing, const ViewParameters& view, ShownObject& shown, double now_s) const {
    if (footing == Footing::kNone) return pose;
    const Geodetic position = ToGeodetic(pose.position_ecef);
    if (footing == Footing::kSea) {
      if (!view.on_sea) return pose;
      const double sea_m = view.exaggeration * SeaHeight(position.latitude_deg, position.longitude_deg);
      return StandOn(pose, sea_m, UpAt(position.latitude_deg, position.longitude_deg));
    }
    if (!view.on_ground || terrain_ == nullptr) return pose;
    const auto ground = GroundUnder(paging_, terrain_->type, position.latitude_deg, position.longitude_deg);
    if (!ground) return pose;
    const GroundPoint standing = shown.ground.Show(*ground, now_s);
    return StandOn(pose, standing.height_m, standing.normal_ecef);
  }

  const ViewId view_id_;
  Paging& paging_;
  const EntityLooks& looks_;
  const ObjectTable& objects_;
  const ClusterManager& clusters_;
  const std::shared_ptr<ViewChannel> channel_;
  const Clock& clock_;
  const Layer* const terrain_;
  const Layer* const models_;
  bool listed_none_ = false;  // of the last list
  uint64_t listed_view_ = 0;
  WatchOutlines outlines_;
  uint64_t number_ = 0;
  ShownObjects shown_;
  GroupSelection groups_;
  std::unordered_map<uint64_t, const EntityLook*> known_looks_;  // by type
  const LabelFormat usual_format_;
  LabelLayout layout_;
  // Of the list that is being made:
  std::vector<ObjectInstance> instances_;
  InstanceGroups placed_;
  std::vector<DrawnModel> drawn_models_;
  std::vector<EffectWish> effect_wishes_;
  std::vector<LabelWish> wishes_;
  std::vector<Wisher> wishers_;  // who wishes[i] is of
  std::vector<std::optional<const ModelPage*>> models_found_;
  PacedThread thread_;  // last: it stops before the members above go
};

ObjectManager::ObjectManager(ViewId view, Paging& paging, const EntityLooks& looks, const ObjectTable& objects,
                             const ClusterManager& clusters, std::shared_ptr<ViewChannel> channel, const Clock& clock)
    : worker_(std::make_unique<Worker>(view, paging, looks, objects, clusters, std::move(channel), clock)),
      view_(view),
      paging_(paging) {}

ObjectManager::~ObjectManager() {
  worker_.reset();
  for (const Layer& layer : paging_.layers.layers()) {
    if (layer.kind == PageKind::kModel) paging_.queue(layer.type).SetWishes(view_, {});
  }
}

}  // namespace belvedere

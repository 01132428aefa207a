#include "runtime/app/view_pilot.h"

#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

namespace belvedere {
namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace

ViewPilot::ViewPilot(ViewId view, const WindowSpec& window, std::vector<NamedLayer> image_layers)
    : view_(view),
      spec_(window.view),
      image_layers_(std::move(image_layers)),
      lens_{window.width_px, window.height_px, Radians::FromDegrees(window.view.vfov_deg)},
      error_px_(spec_.error_px),
      hud_(spec_.hud),
      labels_(spec_.labels),
      effects_(spec_.effects),
      trails_(spec_.trails),
      vectors_(spec_.vectors),
      groups_(spec_.groups),
      frames_(spec_.frames),
      objects_(spec_.objects),
      symbols_(spec_.symbols),
      sky_(spec_.sky) {
  GoHome();
}

void ViewPilot::GoHome() {
  camera_ = Camera::At(spec_.position, spec_.heading_deg, spec_.pitch_deg);
  tether_ = spec_.tether;
  overview_ = spec_.overview;
  velocity_mps_ = glm::dvec3(0.0);
  Place();
}

void ViewPilot::Place() {
  if (spec_.kind == ViewKind::kOverview) camera_ = CameraOf(overview_);
  changed_ = true;
}

void ViewPilot::Resize(int width_px, int height_px) {
  if (width_px < 1 || height_px < 1 || (width_px == lens_.width_px && height_px == lens_.height_px)) return;
  lens_.width_px = width_px;
  lens_.height_px = height_px;
  changed_ = true;
}

void ViewPilot::Apply(const Command& command, const GroundHeight& ground) {
  if (!std::holds_alternative<OrbitCommand>(command)) pivot_.reset();
  ApplySwitches(command);
  switch (spec_.kind) {
    case ViewKind::kFree: ApplyFree(command, ground); break;
    case ViewKind::kTethered:
    case ViewKind::kGodsEye: ApplyFollowing(command); break;
    case ViewKind::kOverview: ApplyOverview(command); break;
  }
}

glm::dvec3 ViewPilot::GroundUnder(const PicturePoint& point, const GroundHeight& ground) const {
  if (spec_.kind != ViewKind::kOverview) return PointUnder(camera_, lens_, point, ground);
  Geodetic place = PlaceUnder(overview_, lens_, point);
  place.height_m = ground(place.latitude_deg, place.longitude_deg);
  return ToEcef(place);
}

glm::dvec3 ViewPilot::PivotOf(const OrbitCommand& orbit, const GroundHeight& ground) {
  const bool same = pivot_ && pivot_->first.x_px == orbit.about.x_px && pivot_->first.y_px == orbit.about.y_px;
  if (!same) pivot_.emplace(orbit.about, PointUnder(camera_, lens_, orbit.about, ground));
  return pivot_->second;
}

void ViewPilot::ApplyFree(const Command& command, const GroundHeight& ground) {
  const auto move_to = [&](const Camera& camera) {
    camera_ = camera;
    changed_ = true;
  };
  std::visit(
      Overloaded{
          [&](const GrabCommand& grab) { held_ = PointUnder(camera_, lens_, grab.at, ground); },
          [&](const PanCommand& pan) {
            if (held_) move_to(Pan(camera_, lens_, *held_, pan.to, ground));
          },
          [&](const ZoomCommand& zoom) { move_to(Zoom(camera_, lens_, zoom.at, zoom.steps, ground)); },
          [&](const OrbitCommand& orbit) {
            move_to(Orbit(camera_, PivotOf(orbit, ground), orbit.around_deg, orbit.tilt_deg, ground));
          },
          [&](const LookCommand& look) { move_to(Look(camera_, lens_, look.right_fraction, look.up_fraction)); },
          [&](const FlyCommand& fly) { rates_ = fly; },
          [&](const GoToCommand& go) { move_to(Lift(Camera::At(go.position, go.heading_deg, go.pitch_deg), ground)); },
          [](const auto&) {},
      },
      command);
}

void ViewPilot::ApplyFollowing(const Command& command) {
  const Tether before = tether_;
  std::visit(Overloaded{
                 [&](const ZoomCommand& zoom) { tether_ = Zoomed(tether_, zoom.steps); },
                 [&](const OrbitCommand& orbit) { tether_ = Orbited(tether_, orbit.around_deg, orbit.tilt_deg); },
                 // A drag that would look around goes round the target instead, as far as the look would have turned.
                 [&](const LookCommand& look) {
                   tether_ = Orbited(tether_, look.right_fraction * lens_.vertical_fov.degrees() * lens_.aspect(),
                                     look.up_fraction * lens_.vertical_fov.degrees());
                 },
                 [&](const FlyCommand& fly) { rates_ = fly; },
                 [](const auto&) {},
             },
             command);
  if (before.distance_m != tether_.distance_m || before.azimuth_deg != tether_.azimuth_deg ||
      before.elevation_deg != tether_.elevation_deg) {
    changed_ = true;
  }
}

void ViewPilot::ApplyOverview(const Command& command) {
  std::visit(Overloaded{
                 [&](const GrabCommand& grab) { held_ = ToEcef(PlaceUnder(overview_, lens_, grab.at)); },
                 [&](const PanCommand& pan) {
                   if (held_) overview_ = Panned(overview_, lens_, ToGeodetic(*held_), pan.to);
                   Place();
                 },
                 [&](const ZoomCommand& zoom) {
                   overview_ = Zoomed(overview_, lens_, zoom.at, zoom.steps);
                   Place();
                 },
                 [&](const GoToCommand& go) {
                   overview_.latitude_deg = go.position.latitude_deg;
                   overview_.longitude_deg = go.position.longitude_deg;
                   Place();
                 },
                 [&](const FlyCommand& fly) { rates_ = fly; },
                 [](const auto&) {},
             },
             command);
}

void ViewPilot::ApplySwitches(const Command& command) {
  if (std::holds_alternative<HomeCommand>(command)) GoHome();
  if (const auto* bound = std::get_if<ErrorBoundCommand>(&command)) error_px_ = bound->error_px;
  if (const auto* scale = std::get_if<ScaleErrorBoundCommand>(&command)) error_px_ *= scale->factor;
  error_px_ = std::clamp(error_px_, kLeastError_px, kMostError_px);
  if (const auto* toggle = std::get_if<ToggleCommand>(&command)) {
    switch (toggle->what) {
      case ViewSwitch::kHud: hud_ = !hud_; break;
      case ViewSwitch::kLabels: labels_ = !labels_; break;
      case ViewSwitch::kObjects: objects_ = !objects_; break;
      case ViewSwitch::kSymbols: symbols_ = !symbols_; break;
      case ViewSwitch::kSky: sky_ = !sky_; break;
      case ViewSwitch::kWireframe: wireframe_ = !wireframe_; break;
      case ViewSwitch::kVolumes: volumes_ = !volumes_; break;
      case ViewSwitch::kPages: pages_ = !pages_; break;
      case ViewSwitch::kFrozen: frozen_ = !frozen_; break;
      case ViewSwitch::kEffects: effects_ = !effects_; break;
      case ViewSwitch::kTrails: trails_ = !trails_; break;
      case ViewSwitch::kVectors: vectors_ = !vectors_; break;
      case ViewSwitch::kGroups: groups_ = !groups_; break;
      case ViewSwitch::kFrames: frames_ = !frames_; break;
    }
  }
  if (const auto* tint = std::get_if<TintCommand>(&command)) {
    const int next = (static_cast<int>(tint_) + 1) % kGroundTints;
    tint_ = tint->tint.value_or(static_cast<GroundTint>(next));
  }
  if (const auto* layer = std::get_if<LayerCommand>(&command)) ApplyLayer(*layer);
  if (std::holds_alternative<ToggleCommand>(command) || std::holds_alternative<LayerCommand>(command) ||
      std::holds_alternative<TintCommand>(command) || std::holds_alternative<ErrorBoundCommand>(command) ||
      std::holds_alternative<ScaleErrorBoundCommand>(command) || std::holds_alternative<AdvanceTimeCommand>(command) ||
      std::holds_alternative<WatchCommand>(command) || std::holds_alternative<ForgetWatchedCommand>(command)) {
    changed_ = true;
  }
}

void ViewPilot::ApplyLayer(const LayerCommand& command) {
  for (size_t i = 0; i < image_layers_.size(); ++i) {
    NamedLayer& layer = image_layers_[i];
    if (command.layer != layer.name && command.layer != std::to_string(i + 1)) continue;
    if (command.setting == "toggle") {
      layer.use.on = !layer.use.on;
    } else {
      // The command's text was checked when it was read.
      BELVEDERE_CHECK(ApplyLayerSetting(command.setting, layer.use).ok());
    }
  }
}

void ViewPilot::Advance(double seconds, const std::optional<Pose>& target, const GroundHeight& ground) {
  if (follows()) {
    if (!rates_.is_still()) {
      tether_ = Orbited(tether_, (rates_.right - rates_.turn_right) * kTurnDegreesPerSecond * seconds,
                        (rates_.pitch_up - rates_.up) * kTurnDegreesPerSecond * seconds);
      tether_ = Zoomed(tether_, rates_.forward * 10.0 * seconds);
    }
    if (!target) {
      changed_ = changed_ || velocity_mps_ != glm::dvec3(0.0);
      velocity_mps_ = glm::dvec3(0.0);
      return;
    }
    camera_ = CameraOf(tether_, *target, ground);
    velocity_mps_ = target->velocity_ecef_mps;
    changed_ = true;
    return;
  }
  if (rates_.is_still()) return;
  if (spec_.kind == ViewKind::kOverview) {
    const double step_px = seconds * 0.5 * lens_.height_px;
    const PicturePoint middle{0.5 * lens_.width_px, 0.5 * lens_.height_px};
    const double right = rates_.right + rates_.turn_right, up = rates_.forward + rates_.pitch_up;
    overview_ = Panned(overview_, lens_, PlaceUnder(overview_, lens_, middle),
                       {middle.x_px - right * step_px, middle.y_px + up * step_px});
    overview_ = Zoomed(overview_, lens_, middle, -rates_.up * 10.0 * seconds);
    Place();
    return;
  }
  camera_ = Fly(camera_, rates_, seconds, ground);
  changed_ = true;
}

bool ViewPilot::TakeChanged() {
  return std::exchange(changed_, false);
}

ViewParameters ViewPilot::Parameters(uint64_t number, double time_s, double utc_s) const {
  ViewParameters view;
  view.view = view_;
  view.number = number;
  view.time_s = time_s;
  view.utc_s = utc_s;
  view.eye_ecef = camera_.eye_ecef;
  view.eye_velocity_mps = velocity_mps_;
  view.ecef_from_camera = camera_.ecef_from_camera;
  view.vertical_fov = lens_.vertical_fov;
  if (spec_.kind == ViewKind::kOverview) {
    view.projection = Projection::kOrthographic;
    view.ortho_height_m = overview_.span_m;
  }
  view.width_px = lens_.width_px;
  view.height_px = lens_.height_px;
  view.error_px = error_px_;
  view.texel_px = spec_.texel_px;
  view.image_layers = UsesOf(image_layers_);
  view.draw_objects = objects_;
  view.symbols = symbols_;
  view.labels = labels_;
  view.label_format = spec_.label_format;
  view.effects = effects_;
  view.on_ground = spec_.on_ground;
  view.on_sea = spec_.on_sea;
  view.groups = groups_;
  view.frames = frames_;
  view.trails_s = trails_ ? spec_.trails_s : 0;
  view.vectors_s = vectors_ ? spec_.vectors_s : 0;
  view.hud = hud_;
  view.sky = sky_;
  view.wireframe = wireframe_;
  view.volumes = volumes_;
  view.pages = pages_;
  view.tint = tint_;
  view.frozen = frozen_;
  return view;
}

}  // namespace belvedere

// ViewPilot: the master copy of one view: where its camera is, how it moves, what it shows. Commands change it; its
// view parameters are what everybody else sees of it.
//
// Of the four kinds of view a free one moves by navigation.h, a tethered one and the God's eye by tether.h, and the
// overview by overview.h. A follower whose target is not there (yet, or no more) stays where it was last.
//
// Units:   seconds of the injected clock; UTC seconds for the sun.
// Threads: the UI thread. No clock, no windows: time and target are handed in.
#pragma once

#include "runtime/app/layer_text.h"
#include "runtime/app/station_file.h"
#include "runtime/scene/commands.h"
#include "runtime/scene/view_parameters.h"

#include <optional>
#include <vector>

namespace belvedere {

class ViewPilot {
 public:
  // image_layers: in the order in which they are drawn.
  ViewPilot(ViewId view, const WindowSpec& window, std::vector<NamedLayer> image_layers);

  // What a view can do about a command; commands for the whole station (time, target, picture, quit) change nothing.
  void Apply(const Command& command, const GroundHeight& ground);
  // The ground under a point of the picture, or the limb where it is in the sky.
  glm::dvec3 GroundUnder(const PicturePoint& point, const GroundHeight& ground) const;
  void Resize(int width_px, int height_px);
  // The camera `seconds` later: flown on, or taken along by the target.
  void Advance(double seconds, const std::optional<Pose>& target, const GroundHeight& ground);

  // `number` must grow with every call.
  ViewParameters Parameters(uint64_t number, double time_s, double utc_s) const;
  // Whether Parameters would give anything new since the last call of this.
  bool TakeChanged();

  ViewKind kind() const { return spec_.kind; }
  const ViewSpec& spec() const { return spec_; }
  const Camera& camera() const { return camera_; }
  bool follows() const { return spec_.kind == ViewKind::kTethered || spec_.kind == ViewKind::kGodsEye; }

 private:
  void GoHome();
  void Place();
  void ApplyFree(const Command& command, const GroundHeight& ground);
  void ApplyFollowing(const Command& command);
  void ApplyOverview(const Command& command);
  void ApplySwitches(const Command& command);
  void ApplyLayer(const LayerCommand& command);
  glm::dvec3 PivotOf(const OrbitCommand& orbit, const GroundHeight& ground);

  const ViewId view_;
  const ViewSpec spec_;
  std::vector<NamedLayer> image_layers_;
  Lens lens_;
  Camera camera_;
  glm::dvec3 velocity_mps_{0.0};
  Tether tether_;
  Overview overview_;
  FlyCommand rates_;
  std::optional<glm::dvec3> held_;                            // ground that a drag took hold of
  std::optional<std::pair<PicturePoint, glm::dvec3>> pivot_;  // of the orbit that is going on
  double error_px_;
  bool hud_, labels_, effects_, trails_, vectors_, groups_, frames_, objects_, symbols_, sky_;
  bool wireframe_ = false, volumes_ = false, pages_ = false, frozen_ = false;
  GroundTint tint_ = GroundTint::kNone;
  bool changed_ = true;
};

inline constexpr double kLeastError_px = 0.25, kMostError_px = 64;

}  // namespace belvedere

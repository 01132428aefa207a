// ViewParameters: all that managers and the render thread need to know of one view, as one immutable value.
//
// The UI thread owns the master copy and publishes a new value whenever something changes; managers and the render
// thread take the newest one. The eye may move between two values (a tethered view): whoever uses one extrapolates with
// eye_velocity to its own time, as objects are extrapolated, so that both stay in step.
//
// Frames: eye and axes in ECEF, metres. Camera axes: right, up, backward (the view looks along -backward).
// Clip space: x right, y up, [-1, 1]; depth reverse-Z: 1 at the near plane, 0 at infinity or the far plane.
// Threads: values.
#pragma once

#include "runtime/base/view_id.h"
#include "runtime/earth/units.h"
#include "runtime/earth/visibility.h"
#include "runtime/paging/layer_table.h"
#include "runtime/paging/page.h"
#include "runtime/scene/importance.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace belvedere {

class LabelFormat;

// One image layer as a view shows it: a texel c becomes multiplier * c^gamma, and opacity says how much of it counts.
struct LayerUse {
  DataType type = 0;  // of a layer with steps, that of the whole layer
  LayerRole role = LayerRole::kColour;
  float opacity = 1, gamma = 1, multiplier = 1;
  bool on = true;
  bool shown() const { return on && opacity > 0; }
  bool operator==(const LayerUse&) const = default;
};

// What the ground is tinted by, to see how it is drawn: the error that each quadnode leaves (blue none, green half the
// bound, yellow the bound, red more), its level, its coordinate frame, or the level of its lowest image.
enum class GroundTint : uint8_t { kNone, kError, kLevel, kFrame, kImage };
inline constexpr int kGroundTints = 5;

enum class Projection : uint8_t { kPerspective, kOrthographic };

struct ViewParameters {
  ViewId view = 0;
  uint64_t number = 0;   // grows with every published value
  double time_s = 0;     // clock time at which the eye was there
  double utc_s = 0;      // simulation time of that moment: where the sun stands, which step of a layer holds
  double time_rate = 1;  // seconds of simulation time a second; 0: it stands still
  glm::dvec3 eye_ecef{};
  glm::dvec3 eye_velocity_mps{};
  glm::dmat3 ecef_from_camera{1.0};  // columns right, up, backward
  Projection projection = Projection::kPerspective;
  Radians vertical_fov{1.0471975511965976};  // perspective: 60 degrees
  double ortho_height_m = 1e6;               // orthographic: ground that the height of the picture spans
  int width_px = 1024, height_px = 768;

  double exaggeration = 1.0;   // of heights, as the station's pages have it: how far one sees
  double error_px = 2.0;       // bound on the screen-space error
  double target_frame_ms = 0;  // where frames take longer, error_px is loosened; 0: it is kept whatever it costs
  double most_error_px = 8.0;  // to which it is loosened at most
  double texel_px = 1.25;      // bound on the size of a texel on the screen
  std::vector<LayerUse> image_layers;  // drawn over each other in this order, kMaxImageLayers at most
  bool draw_objects = true;
  bool symbols = false;   // objects as symbols of constant size instead of models (the overview)
  bool on_ground = true;  // land vehicles and people stand on the drawn ground, whatever height they say
  bool on_sea = true;     // and ships on the sea
  bool labels = true;
  std::shared_ptr<const LabelFormat> label_format;  // nullptr: marking and flight level
  std::shared_ptr<const std::vector<WatchArea>>
      watched;           // outlined on the ground; nullptr: none. The same as long as they are
  bool groups = true;    // many objects that are close together as one symbol
  bool frames = false;   // symbols in a frame whose shape says whose they are
  bool effects = true;   // smoke, fire, lights, marks on the ground
  double trails_s = 0;   // how far back the way of each object is drawn; 0: not
  double vectors_s = 0;  // how far ahead
  bool hud = true;
  bool sky = true;
  bool wireframe = false;
  bool volumes = false;  // bounding volumes of what is drawn
  bool pages = false;    // where the pages of each layer are, in the heads-up display
  GroundTint tint = GroundTint::kNone;
  bool frozen = false;         // managers keep the cut that they have while the eye flies on
  glm::vec3 background{0.0F};  // linear RGB where nothing is drawn (seen with sky off)

  glm::dvec3 EyeAt(double clock_time_s) const { return eye_ecef + eye_velocity_mps * (clock_time_s - time_s); }
  double UtcAt(double clock_time_s) const { return utc_s + time_rate * (clock_time_s - time_s); }
};

// Matrices and planes of a view at one moment, in double.
struct ViewMatrices {
  glm::dvec3 eye_ecef{};
  glm::dmat4 clip_from_camera{1.0};
  glm::dmat4 camera_from_ecef{1.0};  // translation included: use it for points only in double
  glm::dmat4 clip_from_ecef{1.0};
  double near_m = 1;
  double far_m = 1;
  Frustum frustum;
  Horizon horizon;
  // Pixels that one metre across the line of sight spans at distance d from the eye: perspective pixels_per_radian / d,
  // orthographic pixels_per_metre.
  double pixels_per_radian = 0;
  double pixels_per_metre = 0;
};

// Near plane from the height above the ground (terrain or ellipsoid, metres), far plane from the horizon beyond which
// not even the highest mountain is seen.
ViewMatrices MatricesOf(const ViewParameters& view, double clock_time_s, double height_above_ground_m);

// Camera axes for a heading (clockwise from north), pitch (0 level, -90 straight down) and roll (right wing down) at a
// position.
glm::dmat3 CameraAxes(double latitude_deg, double longitude_deg, Radians heading, Radians pitch, Radians roll);

}  // namespace belvedere

#include "render/object_overlay.h"

#include "render/view_block.h"
#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace belvedere {
namespace {

constexpr float kFrame = 1.35F, kInFrame = 0.72F;  // of the usual size: a frame, and the symbol in it
// Overlays are nearer than their object, to stand clear of the ground: far less than a hill away, but close to the eye
// by more, where the ground before an object rises into its label; and from far out by as much as the globe may bulge
// towards the eye on the way to their ends.
constexpr double kNearer = 0.03, kNearerClose = 0.5, kNearest = 0.5;  // of the distance
constexpr double kClose_m = 500, kNotClose_m = 5000;
constexpr double kBulge = 3, kFarOut_m = 1e5;
constexpr double kSymbolReach_px = 14;

// How much of kBulge counts for an eye at that height.
double FarOutOf(const glm::dvec3& eye_ecef) {
  return std::clamp(ToGeodetic(eye_ecef).height_m / kFarOut_m, 0.0, 1.0);
}

// For what ends reach_px from its object.
float DepthOf(const MovedObject& object, double reach_px, double far_out, const ViewParameters& view,
              const ViewMatrices& matrices) {
  const double metres_a_px = view.projection == Projection::kPerspective
                                 ? object.distance_m / matrices.pixels_per_radian
                                 : 1 / matrices.pixels_per_metre;
  const double bulge_m = kBulge * far_out * reach_px * metres_a_px;
  const double away = std::clamp((object.distance_m - kClose_m) / (kNotClose_m - kClose_m), 0.0, 1.0);
  const double least = kNearerClose + away * (kNearer - kNearerClose);
  const double nearer_m = std::clamp(bulge_m, least * object.distance_m, kNearest * object.distance_m);
  return DepthAt(matrices.clip_from_camera, view.projection, object.distance_m - nearer_m);
}

// Angle on the screen, clockwise from up, of where the object's nose points; 0 when it points along the line of sight.
float HeadingOnScreen(const MovedObject& object, const ViewParameters& view) {
  const glm::dvec3 nose = object.ecef_from_body[0];
  const double right = glm::dot(nose, view.ecef_from_camera[0]);
  const double up = glm::dot(nose, view.ecef_from_camera[1]);
  if (right * right + up * up < 1e-6) return 0.0F;
  return static_cast<float>(std::atan2(right, up));
}

// Ground symbols are upright squares; those that have a bow turn with it.
bool Turns(SymbolShape shape) {
  return shape == SymbolShape::kAir || shape == SymbolShape::kSurface;
}

// depth_at(reach_px)
template <typename DepthAtReach>
void AddLabel(const ObjectLabel& label, const MovedObject& object, float beside_px, OverlayBatch::Colour colour,
              const DepthAtReach& depth_at, OverlayBatch& batch) {
  constexpr float kAscent_px = 11, kLeaderWidth_px = 1;
  const std::string text = ToLatin1(label.text);
  const LabelBox box = BoxOf(label.side, beside_px, SizeOf(text));
  const float reach_px = std::max({-box.left, box.right, -box.top, box.bottom});
  const float depth = depth_at(static_cast<double>(reach_px));
  const bool left_of = box.right < 0;
  if (box.has_leader) {
    const glm::vec2 end(left_of ? box.right + 2 : box.left - 2, 0.5F * (box.top + box.bottom));
    const glm::vec2 begin = glm::normalize(end) * std::min(beside_px, glm::length(end));
    batch.AddLine(object.screen_px + begin, object.screen_px + end, kLeaderWidth_px, depth, colour);
  }
  float baseline = object.screen_px.y + box.top + kAscent_px;
  for (size_t at = 0; at < text.size(); baseline += kLabelLine_px) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    const float x = left_of ? box.right - batch.atlas().WidthOf(line) : box.left;
    batch.AddText(object.screen_px.x + x, baseline, depth, line, colour);
    at = end + 1;
  }
}

}  // namespace

void AddObjectOverlay(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
                      const ViewMatrices& matrices, OverlayBatch& batch) {
  const double far_out = FarOutOf(matrices.eye_ecef);
  // Farthest first, so that the nearer symbol covers the farther one.
  for (auto object = objects.rbegin(); object != objects.rend(); ++object) {
    const ObjectInstance& instance = list.instances[object->instance];
    const auto shape = static_cast<SymbolShape>(instance.look.symbol < kSymbolShapes ? instance.look.symbol : 0);
    if (shape == SymbolShape::kNone || DrawnAsModel(instance, view)) continue;
    const float angle = Turns(shape) ? HeadingOnScreen(*object, view) : 0.0F;
    const bool framed = instance.look.frame != 0 && instance.look.frame < kSymbolShapes;
    const float depth = DepthOf(*object, kSymbolReach_px, far_out, view, matrices);
    if (framed) {
      batch.AddSymbol(object->screen_px, depth, static_cast<SymbolShape>(instance.look.frame), 0, kFrame,
                      instance.look.colour);
    }
    batch.AddSymbol(object->screen_px, depth, shape, angle, framed ? kInFrame : 1.0F, instance.look.colour);
  }
  if (!view.labels) return;
  for (const MovedObject& object : objects) {
    const ObjectInstance& instance = list.instances[object.instance];
    if (instance.label == 0 || instance.label >= list.labels.size()) continue;
    const auto depth_at = [&](double reach_px) { return DepthOf(object, reach_px, far_out, view, matrices); };
    AddLabel(list.labels[instance.label], object, BesideLabel(DrawnAsModel(instance, view), object.radius_px),
             instance.look.colour, depth_at, batch);
  }
}

}  // namespace belvedere

#include "render/object_overlay.h"

#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace belvedere {
namespace {

constexpr double kPulledForward =
    0.97;  // overlays are this much nearer than their object, to stand clear of the ground

struct Rectangle {
  float left, top, right, bottom;
  bool Overlaps(const Rectangle& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

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

}  // namespace

void AddObjectOverlay(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
                      const ViewMatrices& matrices, OverlayBatch& batch) {
  const auto depth_of = [&](const MovedObject& object) {
    return DepthAt(matrices.clip_from_camera, view.projection, kPulledForward * object.distance_m);
  };
  // Farthest first, so that the nearer symbol covers the farther one.
  for (auto object = objects.rbegin(); object != objects.rend(); ++object) {
    const ObjectInstance& instance = list.instances[object->instance];
    const auto shape = static_cast<SymbolShape>(std::min<uint8_t>(instance.look.symbol, 5));
    if (shape == SymbolShape::kNone || DrawnAsModel(instance, view)) continue;
    const float angle = Turns(shape) ? HeadingOnScreen(*object, view) : 0.0F;
    batch.AddSymbol(object->screen_px, depth_of(*object), shape, angle, 1.0F, instance.look.colour);
  }
  if (!view.labels) return;
  std::vector<Rectangle> taken;
  for (const MovedObject& object : objects) {
    const ObjectInstance& instance = list.instances[object.instance];
    if (instance.label == 0 || instance.label >= list.labels.size() || taken.size() >= kMaxLabels) continue;
    const std::string text = ToLatin1(list.labels[instance.label]);
    const float beside =
        DrawnAsModel(instance, view) ? std::clamp(object.radius_px, 3.0F, 60.0F) : 0.5F * Atlas::kSymbolSide_px;
    const float left = object.screen_px.x + beside + 3.0F;
    const float baseline = object.screen_px.y + 5.0F;
    const Rectangle place{left - 2.0F, baseline - Atlas::kFontHeight_px, left + batch.atlas().WidthOf(text) + 2.0F,
                          baseline + 4.0F};
    if (std::any_of(taken.begin(), taken.end(), [&](const Rectangle& other) { return place.Overlaps(other); }))
      continue;
    taken.push_back(place);
    batch.AddText(left, baseline, depth_of(object), text, instance.look.colour);
  }
}

}  // namespace belvedere

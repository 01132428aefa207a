#include "render/moved_objects.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

glm::dmat3 Turned(const glm::dmat3& ecef_from_body, const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  if (angle < 1e-9) return ecef_from_body;
  return ecef_from_body * glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, turn / angle));
}

// False when it cannot be seen.
bool PlaceOnScreen(MovedObject& object, double radius_m, const ViewParameters& view, const ViewMatrices& matrices) {
  const BoundingSphere sphere{object.position_ecef, radius_m};
  if (matrices.frustum.Hides(sphere) || matrices.horizon.Hides(sphere)) return false;
  const glm::dvec4 camera = matrices.camera_from_ecef * glm::dvec4(object.position_ecef, 1.0);
  const glm::dvec4 clip = matrices.clip_from_camera * camera;
  object.distance_m = -camera.z;
  if (clip.w <= 0) return false;
  object.screen_px = {static_cast<float>((0.5 + 0.5 * clip.x / clip.w) * view.width_px),
                      static_cast<float>((0.5 - 0.5 * clip.y / clip.w) * view.height_px)};
  const double scale = view.projection == Projection::kPerspective
                           ? matrices.pixels_per_radian / std::max(object.distance_m, matrices.near_m)
                           : matrices.pixels_per_metre;
  object.radius_px = static_cast<float>(scale * radius_m);
  return true;
}

}  // namespace

std::vector<MovedObject> MoveObjects(const DisplayList& list, std::span<const InstanceRange> ranges,
                                     const ViewParameters& view, const ViewMatrices& matrices, double now_s) {
  const double dt = std::clamp(now_s - list.time_s, -kLongestExtrapolation_s, kLongestExtrapolation_s);
  std::vector<MovedObject> moved;
  for (const InstanceRange& range : ranges) {
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
      const ObjectInstance& instance = list.instances[i];
      MovedObject object;
      object.instance = i;
      object.position_ecef = instance.position_ecef + dt * instance.velocity_mps;
      object.ecef_from_body = Turned(instance.ecef_from_body, dt * instance.angular_velocity_body);
      if (PlaceOnScreen(object, instance.radius_m, view, matrices)) moved.push_back(object);
    }
  }
  std::stable_sort(moved.begin(), moved.end(),
                   [](const MovedObject& a, const MovedObject& b) { return a.distance_m < b.distance_m; });
  return moved;
}

bool DrawnAsModel(const ObjectInstance& instance, const ViewParameters& view) {
  return instance.look.model_slot >= 0 && !view.symbols;
}

}  // namespace belvedere

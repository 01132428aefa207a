#include "runtime/scene/view_parameters.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kHighestGround_m = 9'000.0;
// Of the height above the ground. Reverse-Z in 32-bit floats is as exact far away as near by, so the near plane need
// only stay in front of the nearest object: a tethered eye is some tens of metres from its aircraft at any height.
constexpr double kNearShareOfHeight = 5e-4;
constexpr double kNearest_m = 0.1;

double FarPlane(double ellipsoid_height_m, double exaggeration) {
  const double lowest_m = kDeepestGround_m * exaggeration;
  const double highest_m = kHighestGround_m * exaggeration;
  return (HorizonDistance(std::max(ellipsoid_height_m, 10.0) - lowest_m) + HorizonDistance(highest_m - lowest_m)) *
         1.05;
}

// Reverse-Z with a finite far plane: depth 1 at near, 0 at far.
glm::dmat4 PerspectiveClip(double tan_half_height, double aspect, double near_m, double far_m) {
  glm::dmat4 clip(0.0);
  clip[0][0] = 1.0 / (tan_half_height * aspect);
  clip[1][1] = 1.0 / tan_half_height;
  clip[2][2] = near_m / (far_m - near_m);
  clip[2][3] = -1.0;
  clip[3][2] = far_m * near_m / (far_m - near_m);
  return clip;
}

glm::dmat4 OrthographicClip(double half_height_m, double aspect, double near_m, double far_m) {
  glm::dmat4 clip(0.0);
  clip[0][0] = 1.0 / (half_height_m * aspect);
  clip[1][1] = 1.0 / half_height_m;
  clip[2][2] = 1.0 / (far_m - near_m);
  clip[3][2] = far_m / (far_m - near_m);
  clip[3][3] = 1.0;
  return clip;
}

}  // namespace

ViewMatrices MatricesOf(const ViewParameters& view, double clock_time_s, double height_above_ground_m) {
  ViewMatrices matrices;
  matrices.eye_ecef = view.EyeAt(clock_time_s);
  const double ellipsoid_height_m = ToGeodetic(matrices.eye_ecef).height_m;
  matrices.near_m = std::max(
      kNearest_m, kNearShareOfHeight * std::min(height_above_ground_m, std::max(ellipsoid_height_m, kNearest_m)));
  matrices.far_m = std::max(FarPlane(ellipsoid_height_m, view.exaggeration), 10.0 * matrices.near_m);
  const double aspect = static_cast<double>(view.width_px) / static_cast<double>(view.height_px);
  if (view.projection == Projection::kPerspective) {
    const double tan_half = std::tan(0.5 * view.vertical_fov.value);
    matrices.clip_from_camera = PerspectiveClip(tan_half, aspect, matrices.near_m, matrices.far_m);
    matrices.pixels_per_radian = 0.5 * view.height_px / tan_half;
  } else {
    matrices.clip_from_camera = OrthographicClip(0.5 * view.ortho_height_m, aspect, matrices.near_m, matrices.far_m);
    matrices.pixels_per_metre = view.height_px / view.ortho_height_m;
  }
  const glm::dmat3 camera_from_ecef = glm::transpose(view.ecef_from_camera);
  matrices.camera_from_ecef = glm::dmat4(camera_from_ecef);
  matrices.camera_from_ecef[3] = glm::dvec4(-(camera_from_ecef * matrices.eye_ecef), 1.0);
  matrices.clip_from_ecef = matrices.clip_from_camera * matrices.camera_from_ecef;
  matrices.frustum = Frustum(matrices.clip_from_ecef);
  matrices.horizon = Horizon(matrices.eye_ecef, view.exaggeration);
  return matrices;
}

glm::dmat3 CameraAxes(double latitude_deg, double longitude_deg, Radians heading, Radians pitch, Radians roll) {
  const LevelAxes axes = LevelAxesAt(latitude_deg, longitude_deg);
  const glm::dvec3 level_forward = std::sin(heading.value) * axes.east + std::cos(heading.value) * axes.north;
  const glm::dvec3 level_right = std::cos(heading.value) * axes.east - std::sin(heading.value) * axes.north;
  const glm::dvec3 forward = std::cos(pitch.value) * level_forward + std::sin(pitch.value) * axes.up;
  const glm::dvec3 level_up = glm::cross(level_right, forward);
  const glm::dvec3 right = std::cos(roll.value) * level_right - std::sin(roll.value) * level_up;
  return {right, glm::cross(right, forward), -forward};
}

}  // namespace belvedere

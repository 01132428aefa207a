#include "runtime/earth/visibility.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

glm::dvec3 ShrunkenScale(double exaggeration) {
  const double lowest_m = kDeepestGround_m * exaggeration;
  const double equator = 1.0 / (kEquatorialRadius_m + lowest_m);
  return {equator, equator, 1.0 / (kPolarRadius_m + lowest_m)};
}

glm::dvec4 Normalised(const glm::dvec4& plane) {
  return plane / glm::length(glm::dvec3(plane));
}

double Distance(const glm::dvec4& plane, const glm::dvec3& point) {
  return glm::dot(glm::dvec3(plane), point) + plane.w;
}

}  // namespace

Frustum::Frustum(const glm::dmat4& clip_from_ecef) {
  const auto row = [&](int r) {
    return glm::dvec4(clip_from_ecef[0][r], clip_from_ecef[1][r], clip_from_ecef[2][r], clip_from_ecef[3][r]);
  };
  planes_ = {Normalised(row(3) + row(0)), Normalised(row(3) - row(0)), Normalised(row(3) + row(1)),
             Normalised(row(3) - row(1)), Normalised(row(3) - row(2))};
}

bool Frustum::Hides(const BoundingSphere& sphere) const {
  return std::any_of(planes_.begin(), planes_.end(),
                     [&](const glm::dvec4& plane) { return Distance(plane, sphere.center_ecef) < -sphere.radius_m; });
}

bool Frustum::Encloses(const BoundingSphere& sphere) const {
  return std::all_of(planes_.begin(), planes_.end(),
                     [&](const glm::dvec4& plane) { return Distance(plane, sphere.center_ecef) >= sphere.radius_m; });
}

Horizon::Horizon(const glm::dvec3& eye_ecef, double exaggeration)
    : scale_(ShrunkenScale(exaggeration)),
      eye_scaled_(eye_ecef * scale_),
      horizon_squared_(glm::dot(eye_scaled_, eye_scaled_) - 1.0) {}

bool Horizon::Hides(const BoundingSphere& sphere) const {
  if (horizon_squared_ <= 0) return false;
  // In scaled space the sphere becomes an ellipsoid that lies inside a ball of this radius.
  const double radius = sphere.radius_m * scale_.z;
  const glm::dvec3 to_center = sphere.center_ecef * scale_ - eye_scaled_;
  const double distance = glm::length(to_center);
  if (distance <= radius) return false;
  const double eye_distance = std::sqrt(horizon_squared_ + 1.0);
  // Behind the plane of the horizon circle, by the whole ball ...
  const double towards_earth = -glm::dot(to_center, eye_scaled_) / eye_distance;
  if (towards_earth - radius <= horizon_squared_ / eye_distance) return false;
  // ... and inside the cone, by the angle that the ball covers.
  const double cone_angle = std::acos(std::clamp(std::sqrt(horizon_squared_) / eye_distance, -1.0, 1.0));
  const double angle = std::acos(std::clamp(towards_earth / distance, -1.0, 1.0));
  return angle + std::asin(std::clamp(radius / distance, 0.0, 1.0)) < cone_angle;
}

}  // namespace belvedere

#include "runtime/app/tether.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

// The way that the object faces over the ground; the way that it moves when it stands on its nose.
double HeadingOf(const Pose& target, const LevelAxes& level) {
  const auto level_part = [&](const glm::dvec3& v) {
    return glm::dvec2(glm::dot(v, level.east), glm::dot(v, level.north));
  };
  glm::dvec2 ahead = level_part(target.ecef_from_body[0]);
  if (glm::length(ahead) < 0.1) ahead = level_part(target.velocity_ecef_mps);
  return glm::length(ahead) > 0 ? std::atan2(ahead.x, ahead.y) * kDegreesPerRadian : 0.0;
}

}  // namespace

Camera CameraOf(const Tether& tether, const Pose& target, const GroundHeight& ground) {
  const Geodetic place = ToGeodetic(target.position_ecef);
  const LevelAxes level = LevelAxesAt(place.latitude_deg, place.longitude_deg);
  const double heading_deg = (tether.follows_heading ? HeadingOf(target, level) : 0.0) + tether.azimuth_deg;
  Camera camera;
  camera.ecef_from_camera = CameraAxes(place.latitude_deg, place.longitude_deg, Radians::FromDegrees(heading_deg),
                                       Radians::FromDegrees(-tether.elevation_deg), Radians{0});
  camera.eye_ecef = target.position_ecef - camera.forward() * tether.distance_m;
  const Camera lifted = Lift(camera, ground);
  if (lifted.eye_ecef == camera.eye_ecef) return camera;
  // Lifted over a ridge: look down at the target from there.
  const glm::dvec3 backward = glm::normalize(lifted.eye_ecef - target.position_ecef);
  const glm::dvec3 across = glm::cross(level.up, backward);
  if (glm::length(across) < 1e-6) return lifted;
  const glm::dvec3 right = glm::normalize(across);
  return {lifted.eye_ecef, glm::dmat3(right, glm::cross(backward, right), backward)};
}

Tether Orbited(const Tether& tether, double around_deg, double tilt_deg) {
  Tether orbited = tether;
  orbited.azimuth_deg = std::remainder(tether.azimuth_deg + around_deg, 360.0);
  orbited.elevation_deg = std::clamp(tether.elevation_deg - tilt_deg, -80.0, 90.0);
  return orbited;
}

Tether Zoomed(const Tether& tether, double steps) {
  Tether zoomed = tether;
  zoomed.distance_m =
      std::clamp(tether.distance_m * std::pow(1.0 - kZoomShare, steps), kShortestTether_m, kLongestTether_m);
  return zoomed;
}

}  // namespace belvedere

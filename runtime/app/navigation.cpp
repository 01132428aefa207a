#include "runtime/app/navigation.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kRecentreHeight_m = 4'000e3;  // above it, going away from the Earth turns it back to the middle
constexpr double kRecentreShare = 0.15;        // of the angle that is left, a step
constexpr double kHighestPitch_deg = 85.0;     // for orbiting

glm::dmat3 RotationAbout(const glm::dvec3& axis, double angle) {
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, axis));
}

glm::dmat3 Orthonormal(const glm::dmat3& axes) {
  const glm::dvec3 backward = glm::normalize(axes[2]);
  const glm::dvec3 right = glm::normalize(glm::cross(axes[1], backward));
  return {right, glm::cross(backward, right), backward};
}

glm::dvec3 UpAtPoint(const glm::dvec3& ecef) {
  const Geodetic place = ToGeodetic(ecef);
  return UpAt(place.latitude_deg, place.longitude_deg);
}

Camera Turned(const Camera& camera, const glm::dmat3& rotation, const glm::dvec3& centre) {
  return {centre + rotation * (camera.eye_ecef - centre), Orthonormal(rotation * camera.ecef_from_camera)};
}

// The rotation about the Earth's centre that takes the direction `from` to the direction `to`.
glm::dmat3 RotationBetween(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 axis = glm::cross(glm::normalize(from), glm::normalize(to));
  const double sine = glm::length(axis);
  if (sine < 1e-15) return glm::dmat3(1.0);
  return RotationAbout(axis / sine, std::atan2(sine, glm::dot(glm::normalize(from), glm::normalize(to))));
}

// Where the sight line meets the sphere about the Earth's centre with that radius, or comes nearest to it.
glm::dvec3 OnSphere(const SightLine& line, double radius_m) {
  const double along = -glm::dot(line.origin_ecef, line.direction);
  const glm::dvec3 nearest = line.origin_ecef + line.direction * along;
  const double half_squared = radius_m * radius_m - glm::dot(nearest, nearest);
  if (half_squared <= 0) return glm::normalize(nearest) * radius_m;
  const double half = std::sqrt(half_squared);
  const double distance = along - half > 0 ? along - half : along + half;
  return line.origin_ecef + line.direction * distance;
}

double HeightOverGround(const glm::dvec3& eye_ecef, const GroundHeight& ground) {
  const Geodetic place = ToGeodetic(eye_ecef);
  return place.height_m - ground(place.latitude_deg, place.longitude_deg);
}

Camera Recentred(const Camera& camera, double steps_away) {
  const double share = 1.0 - std::pow(1.0 - kRecentreShare, steps_away);
  const glm::dvec3 to_centre = -glm::normalize(camera.eye_ecef);
  const double angle = std::acos(std::clamp(glm::dot(camera.forward(), to_centre), -1.0, 1.0));
  if (angle < 1e-9) return camera;
  const glm::dvec3 axis = glm::normalize(glm::cross(camera.forward(), to_centre));
  return {camera.eye_ecef, Orthonormal(RotationAbout(axis, share * angle) * camera.ecef_from_camera)};
}

}  // namespace

Camera Camera::At(const Geodetic& position, double heading_deg, double pitch_deg, double roll_deg) {
  return {ToEcef(position), CameraAxes(position.latitude_deg, position.longitude_deg, Radians::FromDegrees(heading_deg),
                                       Radians::FromDegrees(pitch_deg), Radians::FromDegrees(roll_deg))};
}

Attitude AttitudeOf(const Camera& camera) {
  const Geodetic place = ToGeodetic(camera.eye_ecef);
  const LevelAxes axes = LevelAxesAt(place.latitude_deg, place.longitude_deg);
  const glm::dvec3 forward = camera.forward(), right = camera.ecef_from_camera[0], up = camera.ecef_from_camera[1];
  const double climb = glm::dot(forward, axes.up);
  const double level = std::hypot(glm::dot(forward, axes.east), glm::dot(forward, axes.north));
  Attitude attitude;
  attitude.pitch_deg = std::atan2(climb, level) * kDegreesPerRadian;
  if (level < 1e-9) {
    const glm::dvec3 ahead = climb < 0 ? up : -up;
    attitude.heading_deg = std::atan2(glm::dot(ahead, axes.east), glm::dot(ahead, axes.north)) * kDegreesPerRadian;
    return attitude;
  }
  attitude.heading_deg = std::atan2(glm::dot(forward, axes.east), glm::dot(forward, axes.north)) * kDegreesPerRadian;
  attitude.roll_deg = std::atan2(-glm::dot(right, axes.up), glm::dot(up, axes.up)) * kDegreesPerRadian;
  return attitude;
}

SightLine SightThrough(const Camera& camera, const Lens& lens, const PicturePoint& point) {
  const double tan_half = std::tan(0.5 * lens.vertical_fov.value);
  const double x = (2.0 * point.x_px / lens.width_px - 1.0) * tan_half * lens.aspect();
  const double y = (1.0 - 2.0 * point.y_px / lens.height_px) * tan_half;
  return {camera.eye_ecef, glm::normalize(camera.ecef_from_camera * glm::dvec3(x, y, -1.0))};
}

glm::dvec3 PointUnder(const Camera& camera, const Lens& lens, const PicturePoint& point, const GroundHeight& ground) {
  const SightLine line = SightThrough(camera, lens, point);
  const auto met = MeetGround(line, ground);
  return met ? *met : NearestOnLimb(line);
}

Camera Level(const Camera& camera, const glm::dvec3& axis) {
  // right(angle) = a cos + b sin + c, with a, b the part of `right` across the axis and c the part along it.
  const glm::dvec3 up = UpAtPoint(camera.eye_ecef);
  const glm::dvec3 right = camera.ecef_from_camera[0];
  const glm::dvec3 along = axis * glm::dot(axis, right);
  const double a = glm::dot(right - along, up), b = glm::dot(glm::cross(axis, right), up), c = glm::dot(along, up);
  const double size = std::hypot(a, b);
  if (size < 1e-9 || std::abs(c) > size) return camera;
  const double middle = std::atan2(b, a), spread = std::acos(std::clamp(-c / size, -1.0, 1.0));
  const double first = std::remainder(middle + spread, 2 * std::numbers::pi);
  const double second = std::remainder(middle - spread, 2 * std::numbers::pi);
  const double angle = std::abs(first) < std::abs(second) ? first : second;
  if (std::abs(angle) > 0.5) return camera;  // nearly straight down: there is no horizon to level
  return {camera.eye_ecef, Orthonormal(RotationAbout(axis, angle) * camera.ecef_from_camera)};
}

Camera Lift(const Camera& camera, const GroundHeight& ground) {
  Geodetic place = ToGeodetic(camera.eye_ecef);
  const double lowest = ground(place.latitude_deg, place.longitude_deg) + kLeastClearance_m;
  if (place.height_m >= lowest && place.height_m <= kFarthest_m) return camera;
  place.height_m = std::clamp(place.height_m, lowest, kFarthest_m);
  return {ToEcef(place), camera.ecef_from_camera};
}

Camera Pan(const Camera& camera, const Lens& lens, const glm::dvec3& held_ecef, const PicturePoint& to,
           const GroundHeight& ground) {
  const SightLine line = SightThrough(camera, lens, to);
  const glm::dvec3 under = OnSphere(line, glm::length(held_ecef));
  const glm::dmat3 rotation = RotationBetween(under, held_ecef);
  const Camera turned = Turned(camera, rotation, glm::dvec3(0.0));
  return Lift(Level(turned, glm::normalize(held_ecef - turned.eye_ecef)), ground);
}

Camera Zoom(const Camera& camera, const Lens& lens, const PicturePoint& at, double steps, const GroundHeight& ground) {
  const SightLine line = SightThrough(camera, lens, at);
  const auto met = MeetGround(line, ground);
  const double height = std::max(HeightOverGround(camera.eye_ecef, ground), kLeastClearance_m);
  const glm::dvec3 target = met ? *met : line.origin_ecef + line.direction * height;
  Camera zoomed = camera;
  zoomed.eye_ecef = target + (camera.eye_ecef - target) * std::pow(1.0 - kZoomShare, steps);
  if (steps < 0 && ToGeodetic(zoomed.eye_ecef).height_m > kFarthest_m) zoomed.eye_ecef = camera.eye_ecef;
  if (steps < 0 && ToGeodetic(zoomed.eye_ecef).height_m > kRecentreHeight_m) zoomed = Recentred(zoomed, -steps);
  return Lift(zoomed, ground);
}

Camera Orbit(const Camera& camera, const glm::dvec3& about_ecef, double around_deg, double tilt_deg,
             const GroundHeight& ground) {
  const glm::dvec3 up = UpAtPoint(about_ecef);
  const Camera around = Turned(camera, RotationAbout(up, around_deg * kRadiansPerDegree), about_ecef);
  // The pitch about the camera's right-hand axis, from level at the point, so that straight down is never passed.
  const glm::dvec3 right = around.ecef_from_camera[0];
  const glm::dvec3 upright = up - right * glm::dot(up, right);
  const double pitch_deg =
      std::atan2(glm::dot(around.forward(), upright), glm::dot(around.ecef_from_camera[1], upright)) *
      kDegreesPerRadian;
  const double highest_deg = std::max(kHighestPitch_deg, pitch_deg);
  const double tilted_deg = std::clamp(pitch_deg + tilt_deg, -90.0, highest_deg);
  Camera tilted = Turned(around, RotationAbout(right, (tilted_deg - pitch_deg) * kRadiansPerDegree), about_ecef);
  const glm::dvec3 sight = about_ecef - tilted.eye_ecef;
  if (glm::length(sight) > 0) tilted = Level(tilted, glm::normalize(sight));
  return Lift(tilted, ground);
}

Camera Look(const Camera& camera, const Lens& lens, double right_fraction, double up_fraction) {
  const Geodetic place = ToGeodetic(camera.eye_ecef);
  const double horizontal_fov = 2.0 * std::atan(std::tan(0.5 * lens.vertical_fov.value) * lens.aspect());
  const Attitude attitude = AttitudeOf(camera);
  const double heading_deg = attitude.heading_deg + right_fraction * horizontal_fov * kDegreesPerRadian;
  const double pitch_deg = std::clamp(attitude.pitch_deg + up_fraction * lens.vertical_fov.degrees(), -90.0, 90.0);
  return {camera.eye_ecef, CameraAxes(place.latitude_deg, place.longitude_deg, Radians::FromDegrees(heading_deg),
                                      Radians::FromDegrees(pitch_deg), Radians::FromDegrees(attitude.roll_deg))};
}

Camera Fly(const Camera& camera, const FlyCommand& rates, double seconds, const GroundHeight& ground) {
  const Geodetic start = ToGeodetic(camera.eye_ecef);
  const LevelAxes level = LevelAxesAt(start.latitude_deg, start.longitude_deg);
  const Attitude attitude = AttitudeOf(camera);
  const double over_ground_m = std::max(HeightOverGround(camera.eye_ecef, ground), 0.0);
  const double step_m = std::max(kFlightHeightsPerSecond * over_ground_m, kSlowestFlight_mps) * seconds;

  const double heading = attitude.heading_deg * kRadiansPerDegree;
  const glm::dvec3 ahead = std::sin(heading) * level.east + std::cos(heading) * level.north;
  const glm::dvec3 right = std::cos(heading) * level.east - std::sin(heading) * level.north;
  const glm::dvec3 way = (ahead * rates.forward + right * rates.right) * step_m;
  Camera flown = camera;
  if (const double length = glm::length(way); length > 0) {
    const glm::dvec3 axis = glm::normalize(glm::cross(camera.eye_ecef, way));
    flown = Turned(camera, RotationAbout(axis, length / glm::length(camera.eye_ecef)), glm::dvec3(0.0));
  }
  Geodetic place = ToGeodetic(flown.eye_ecef);
  place.height_m = start.height_m + rates.up * step_m;  // the centre of the turn is not that of the ellipsoid's curve
  flown.eye_ecef = ToEcef(place);

  // The turn about the Earth's centre carries the heading along a great circle; then the pilot turns.
  const Attitude carried = AttitudeOf(flown);
  const double turn_deg = kTurnDegreesPerSecond * seconds;
  flown.ecef_from_camera = CameraAxes(
      place.latitude_deg, place.longitude_deg, Radians::FromDegrees(carried.heading_deg + rates.turn_right * turn_deg),
      Radians::FromDegrees(std::clamp(attitude.pitch_deg + rates.pitch_up * turn_deg, -90.0, 90.0)), Radians{0});
  return Lift(flown, ground);
}

}  // namespace belvedere

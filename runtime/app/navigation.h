// Navigation: how a camera moves over the Earth when somebody drags, scrolls or flies.
//
// A Camera is a place and three axes in ECEF, so poles and 180 E are places like any other. Every gesture is a function
// from a camera to the next one:
//   Pan     turns the camera about the Earth's centre by the angle between two ground points I1 and I2, about the axis
//           I1 x I2 (Kaiser, "AgentFly visualisation", 2018): the point under the cursor stays under the cursor. Then
//           the horizon is levelled by a turn about the line of sight to that point, which leaves it where it is.
//   Zoom    goes a fixed share of the distance towards the ground under the cursor, which stays under the cursor.
//   Orbit   turns about a point of the ground: round its upright, and up and down between straight down and level.
//   Look    turns where the camera stands, by the field of view for a whole picture.
//   Fly     goes on along the Earth's curve with a speed that grows with the height over the ground.
// After each, Lift keeps the camera at least kLeastClearance_m over the ground.
//
// Units and frames: ECEF metres, degrees where a name says so; pixels from the top left.
// Threads: pure functions, as far as the GroundHeight is.
#pragma once

#include "runtime/app/ground.h"
#include "runtime/scene/commands.h"
#include "runtime/scene/view_parameters.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace belvedere {

inline constexpr double kLeastClearance_m = 2.0;
inline constexpr double kFarthest_m = 100e6;  // from the ellipsoid
inline constexpr double kZoomShare = 0.10;    // of the distance, a step
inline constexpr double kFlightHeightsPerSecond = 0.7;
inline constexpr double kSlowestFlight_mps = 10.0;
inline constexpr double kTurnDegreesPerSecond = 45.0;

struct Lens {
  int width_px = 1024, height_px = 768;
  Radians vertical_fov{1.0471975511965976};
  double aspect() const { return static_cast<double>(width_px) / height_px; }
};

struct Camera {
  glm::dvec3 eye_ecef{};
  glm::dmat3 ecef_from_camera{1.0};  // columns right, up, backward

  glm::dvec3 forward() const { return -ecef_from_camera[2]; }
  static Camera At(const Geodetic& position, double heading_deg, double pitch_deg, double roll_deg = 0);
};

struct Attitude {
  double heading_deg = 0, pitch_deg = 0, roll_deg = 0;
};
// Straight up or down, where only heading and roll together are known, the roll is 0.
Attitude AttitudeOf(const Camera& camera);

SightLine SightThrough(const Camera& camera, const Lens& lens, const PicturePoint& point);
// The ground under the point, or the limb when the point is in the sky.
glm::dvec3 PointUnder(const Camera& camera, const Lens& lens, const PicturePoint& point, const GroundHeight& ground);

// Brings `held` (a point of the ground that was taken hold of) under the point `to`.
Camera Pan(const Camera& camera, const Lens& lens, const glm::dvec3& held_ecef, const PicturePoint& to,
           const GroundHeight& ground);
Camera Zoom(const Camera& camera, const Lens& lens, const PicturePoint& at, double steps, const GroundHeight& ground);
Camera Orbit(const Camera& camera, const glm::dvec3& about_ecef, double around_deg, double tilt_deg,
             const GroundHeight& ground);
Camera Look(const Camera& camera, const Lens& lens, double right_fraction, double up_fraction);
Camera Fly(const Camera& camera, const FlyCommand& rates, double seconds, const GroundHeight& ground);

// The camera raised, if need be, to kLeastClearance_m over the ground, and lowered to kFarthest_m.
Camera Lift(const Camera& camera, const GroundHeight& ground);
// The camera with its horizon level: turned about `axis` (unit length, through the eye) by the least angle that does.
Camera Level(const Camera& camera, const glm::dvec3& axis);

}  // namespace belvedere

#include "dis/traffic_vehicle.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/units.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace belvedere::dis {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity_mps2 = 9.80665;
constexpr double kRollIn_s = 4.0;      // from level to the bank of a turn
constexpr double kDifference_s = 0.1;  // positions are good to 1e-9 m, so rates are to 1e-7

double Lap(const Course& course) {
  return 2.0 * (course.leg_m + kPi * course.radius_m);
}

double AlongLap(const Course& course, double time_s) {
  const double lap_m = Lap(course), run_m = course.phase_m + course.speed_mps * time_s;
  return run_m - lap_m * std::floor(run_m / lap_m);
}

struct OnTrack {
  double ahead_m, right_m;  // of the centre, along the heading and across it
};

OnTrack Track(const Course& course, double along_m) {
  const double leg = course.leg_m, r = course.radius_m, half_circle = kPi * r;
  OnTrack at{};
  if (along_m < leg) {
    at = {along_m - 0.5 * leg, -r};
  } else if (along_m < leg + half_circle) {
    const double angle = (along_m - leg) / r;
    at = {0.5 * leg + r * std::sin(angle), -r * std::cos(angle)};
  } else if (along_m < 2.0 * leg + half_circle) {
    at = {0.5 * leg - (along_m - leg - half_circle), r};
  } else {
    const double angle = (along_m - 2.0 * leg - half_circle) / r;
    at = {-0.5 * leg - r * std::sin(angle), r * std::cos(angle)};
  }
  if (!course.clockwise) at.right_m = -at.right_m;
  return at;
}

Geodetic GeodeticOn(const Course& course, double time_s) {
  const double along_m = AlongLap(course, time_s);
  const OnTrack at = Track(course, along_m);
  const double heading = course.heading_deg * kRadiansPerDegree;
  const double north_m = at.ahead_m * std::cos(heading) - at.right_m * std::sin(heading);
  const double east_m = at.ahead_m * std::sin(heading) + at.right_m * std::cos(heading);
  const double sine = std::sin(course.latitude_deg * kRadiansPerDegree);
  const double flat = 1.0 - kEccentricitySquared * sine * sine;
  const double prime_vertical_m = kEquatorialRadius_m / std::sqrt(flat);
  const double meridian_m = prime_vertical_m * (1.0 - kEccentricitySquared) / flat;
  Geodetic position;
  position.latitude_deg = course.latitude_deg + north_m / meridian_m * kDegreesPerRadian;
  const double parallel_m = prime_vertical_m * std::cos(position.latitude_deg * kRadiansPerDegree);
  position.longitude_deg = course.longitude_deg + east_m / parallel_m * kDegreesPerRadian;
  position.height_m = course.height_m;
  if (course.swing_m != 0.0) position.height_m += course.swing_m * std::sin(2.0 * kPi * along_m / Lap(course));
  return position;
}

// How much of [from, to] lies in [begin, end].
double Overlap(double from, double to, double begin, double end) {
  return std::max(0.0, std::min(to, end) - std::max(from, begin));
}

// The bank of the turn, averaged over the time that rolling takes, so that it neither jumps nor lags.
double Bank(const Course& course, double time_s) {
  const double along_m = AlongLap(course, time_s), lap_m = Lap(course);
  const double half_circle = kPi * course.radius_m;
  const double window_m = std::min(course.speed_mps * kRollIn_s, 0.5 * lap_m);
  const double from = along_m - 0.5 * window_m, to = along_m + 0.5 * window_m;
  double turning_m = 0;
  for (const double shift : {-lap_m, 0.0, lap_m}) {
    turning_m += Overlap(from, to, shift + course.leg_m, shift + course.leg_m + half_circle);
    turning_m += Overlap(from, to, shift + lap_m - half_circle, shift + lap_m);
  }
  const double side_mps2 = course.speed_mps * course.speed_mps / course.radius_m * turning_m / window_m;
  return (course.clockwise ? 1.0 : -1.0) * std::atan(side_mps2 / kGravity_mps2);
}

glm::dmat3 AxesAlong(const glm::dvec3& velocity_mps, const glm::dvec3& up, double bank_rad) {
  const glm::dvec3 forward = glm::normalize(velocity_mps);
  const glm::dvec3 level_right = glm::normalize(glm::cross(forward, up));
  const glm::dvec3 level_down = glm::cross(forward, level_right);
  const double sine = std::sin(bank_rad), cosine = std::cos(bank_rad);
  return {forward, cosine * level_right + sine * level_down, cosine * level_down - sine * level_right};
}

}  // namespace

bool IsThere(const Vehicle& vehicle, double time_s) {
  return vehicle.track == nullptr || vehicle.track->Covers(time_s);
}

glm::dvec3 PositionOf(const Vehicle& vehicle, double time_s) {
  return vehicle.track != nullptr ? vehicle.track->PositionAt(time_s) : ToEcef(GeodeticOn(vehicle.course, time_s));
}

namespace {

// The time that rates are measured over, on each side; shorter where time runs faster.
double DifferenceOf(const Vehicle& vehicle) {
  return kDifference_s / vehicle.time_scale;
}

glm::dvec3 AccelerationOf(const Vehicle& vehicle, double time_s) {
  const double d = DifferenceOf(vehicle);
  return (PositionOf(vehicle, time_s - d) - 2.0 * PositionOf(vehicle, time_s) + PositionOf(vehicle, time_s + d)) /
         (d * d);
}

// A coordinated turn on a track: the bank that its sideways acceleration takes, as it was flown.
double BankOnTrack(const Vehicle& vehicle, double time_s, const glm::dvec3& velocity, const glm::dvec3& up) {
  constexpr double kSteepest_rad = 0.6;
  const double scale = vehicle.time_scale * vehicle.time_scale;
  const glm::dvec3 right = glm::normalize(glm::cross(velocity, up));
  const double sideways_mps2 = glm::dot(AccelerationOf(vehicle, time_s), right) / scale;
  return std::clamp(std::atan(sideways_mps2 / kGravity_mps2), -kSteepest_rad, kSteepest_rad);
}

}  // namespace

Pose TruePose(const Vehicle& vehicle, double time_s) {
  const double d = DifferenceOf(vehicle);
  Pose pose;
  pose.position_ecef = PositionOf(vehicle, time_s);
  const Geodetic place = ToGeodetic(pose.position_ecef);
  const glm::dvec3 up = UpAt(place.latitude_deg, place.longitude_deg);
  pose.velocity_ecef_mps = (PositionOf(vehicle, time_s + d) - PositionOf(vehicle, time_s - d)) / (2.0 * d);
  if (glm::length(pose.velocity_ecef_mps) < 1e-3) {  // it stands: nose to the north
    pose.ecef_from_body = AxesAlong(LevelAxesAt(place.latitude_deg, place.longitude_deg).north, up, 0.0);
    return pose;
  }
  double bank_rad = 0;
  if (vehicle.track != nullptr) {
    bank_rad = BankOnTrack(vehicle, time_s, pose.velocity_ecef_mps, up);
  } else if (vehicle.course.banks) {
    bank_rad = Bank(vehicle.course, time_s);
  }
  pose.ecef_from_body = AxesAlong(pose.velocity_ecef_mps, up, bank_rad);
  return pose;
}

TrueState TrueStateOf(const Vehicle& vehicle, double time_s) {
  const double d = DifferenceOf(vehicle);
  TrueState state;
  state.pose = TruePose(vehicle, time_s);
  const Pose before = TruePose(vehicle, time_s - d);
  const Pose after = TruePose(vehicle, time_s + d);
  state.acceleration_ecef_mps2 =
      (before.position_ecef - 2.0 * state.pose.position_ecef + after.position_ecef) / (d * d);
  // A small turn is the skew part of its matrix.
  const glm::dmat3 turn = glm::transpose(before.ecef_from_body) * after.ecef_from_body;
  state.angular_velocity_radps =
      glm::dvec3(turn[1].z - turn[2].y, turn[2].x - turn[0].z, turn[0].y - turn[1].x) / (4.0 * d);
  return state;
}

KinematicState Report(const Vehicle& vehicle, double time_s) {
  const TrueState truth = TrueStateOf(vehicle, time_s);
  const DeadReckoning model = vehicle.model;
  KinematicState report;
  report.model = model;
  report.time_s = time_s;
  report.position_ecef = truth.pose.position_ecef;
  report.orientation = ToEulerAngles(truth.pose.ecef_from_body);
  report.velocity_mps = truth.pose.velocity_ecef_mps;
  if (ModelAccelerates(model)) report.acceleration_mps2 = truth.acceleration_ecef_mps2;
  if (ModelRotates(model)) report.angular_velocity_radps = truth.angular_velocity_radps;
  if (ModelUsesBodyAxes(model)) {
    const glm::dmat3 body_from_ecef = glm::transpose(truth.pose.ecef_from_body);
    report.velocity_mps = body_from_ecef * truth.pose.velocity_ecef_mps;
    // What is left when the turning of the axes themselves is taken off.
    report.acceleration_mps2 =
        body_from_ecef * truth.acceleration_ecef_mps2 - glm::cross(truth.angular_velocity_radps, report.velocity_mps);
  }
  return report;
}

}  // namespace belvedere::dis

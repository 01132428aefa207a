// Vehicles of synthetic traffic: what each is, the closed course it keeps to, and its true state at any time.
//
// A course is a racetrack: two straight legs joined by two half circles, laid on the ground about a centre, run through
// at one speed, with the height swinging once a lap. Aircraft bank for their turns, and roll in and out of them over a
// few seconds. The true state is a pure function of time: positions are in closed form, rates are differences of them.
//
// Units:   metres, seconds, degrees in the course; time counts from the start of the traffic.
// Threads: pure functions.
#pragma once

#include "dis/pdu.h"
#include "runtime/base/status.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/object_table.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere::dis {

struct Course {
  double latitude_deg = 0, longitude_deg = 0;  // centre
  double heading_deg = 0;                      // of the first leg, clockwise from north
  double leg_m = 0;
  double radius_m = 0;
  bool clockwise = true;
  double speed_mps = 0;
  double phase_m = 0;   // how far along it is at time 0
  double height_m = 0;  // above the ellipsoid
  double swing_m = 0;   // amplitude of the height
  bool banks = true;
};

struct Vehicle {
  EntityType type;
  uint8_t force = 3;
  uint32_t appearance = 0;
  Marking marking;
  DeadReckoning model = DeadReckoning::kFpw;
  Course course;
};

struct TrueState {
  Pose pose;
  glm::dvec3 acceleration_ecef_mps2{0.0};
  glm::dvec3 angular_velocity_radps{0.0};  // about body axes
};

glm::dvec3 PositionOn(const Course& course, double time_s);
// Without the accelerations: what a comparison with dead reckoning takes.
Pose TruePose(const Course& course, double time_s);
TrueState TrueStateOf(const Course& course, double time_s);
// The state as a report by that model gives it: body axes where the model wants them.
KinematicState Report(const Course& course, DeadReckoning model, double time_s);

// "sierra": four in five fly over and around the Sierra Nevada, one in five drives in the Owens valley.
// "storm": airliners and fighters all over the world. The same seed gives the same vehicles.
inline constexpr size_t kMostVehicles = 1'000'000;
Result<std::vector<Vehicle>> MakeVehicles(std::string_view scenario, size_t count, uint64_t seed);

}  // namespace belvedere::dis

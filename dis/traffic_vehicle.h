// Vehicles of synthetic traffic: what each is, the closed course or the recorded track it keeps to, and its true state
// at any time.
//
// A course is a racetrack: two straight legs joined by two half circles, laid on the ground about a centre, run through
// at one speed, with the height swinging once a lap. Aircraft bank for their turns, and roll in and out of them over a
// few seconds. The true state is a pure function of time: positions are in closed form, rates are differences of them.
//
// Units:   metres, seconds, degrees in the course; time counts from the start of the traffic.
// Threads: pure functions.
#pragma once

#include "dis/flight_track.h"
#include "dis/pdu.h"
#include "runtime/base/status.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/object_table.h"

#include <cstdint>
#include <memory>
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
  std::shared_ptr<const FlightTrack> track{};  // instead of the course
  double time_scale = 1;                       // how much faster than it was the track is flown
};

struct TrueState {
  Pose pose;
  glm::dvec3 acceleration_ecef_mps2{0.0};
  glm::dvec3 angular_velocity_radps{0.0};  // about body axes
};

// A vehicle of a track that does not loop is there for a while only.
bool IsThere(const Vehicle& vehicle, double time_s);
glm::dvec3 PositionOf(const Vehicle& vehicle, double time_s);
// Without the accelerations: what a comparison with dead reckoning takes.
Pose TruePose(const Vehicle& vehicle, double time_s);
TrueState TrueStateOf(const Vehicle& vehicle, double time_s);
// The state as a report by the vehicle's model gives it: body axes where the model wants them.
KinematicState Report(const Vehicle& vehicle, double time_s);

// "sierra": four in five fly over and around the Sierra Nevada, one in five drives in the Owens valley.
// "storm": airliners and fighters all over the world. "airways": airliners there and back between large airports.
// "convoy": tanks and trucks in a column in the Owens valley. "dogfight": fighters behind each other in pairs over it,
// an opposing one in front. The same seed gives the same vehicles.
inline constexpr size_t kMostVehicles = 1'000'000;
Result<std::vector<Vehicle>> MakeVehicles(std::string_view scenario, size_t count, uint64_t seed);

}  // namespace belvedere::dis

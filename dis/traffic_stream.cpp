#include "dis/traffic_stream.h"

#include "dis/adsb.h"
#include "dis/timestamp.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace belvedere::dis {
namespace {

constexpr double kStep_s = 0.05;
constexpr uint64_t kStepsPerCheck = 2;  // each entity is looked at every other step
constexpr uint64_t kStepsToStart = 20;  // first reports are spread over a second
constexpr double kRateStep_s = 0.005;   // with a rate: how finely PDUs are handed over
constexpr size_t kPerApplication = 60000;

EntityState ToEntityState(const Vehicle& vehicle, const EntityId& id, const KinematicState& motion) {
  EntityState state;
  state.id = id;
  state.force = vehicle.force;
  state.type = state.alternative_type = vehicle.type;
  state.appearance = vehicle.appearance;
  std::ranges::copy(vehicle.marking.view(), state.marking.begin());
  state.model = static_cast<uint8_t>(motion.model);
  state.position_ecef = motion.position_ecef;
  state.velocity_mps = glm::vec3(motion.velocity_mps);
  state.acceleration_mps2 = glm::vec3(motion.acceleration_mps2);
  state.angular_velocity_radps = glm::vec3(motion.angular_velocity_radps);
  const EulerAngles& angles = motion.orientation;
  state.orientation_rad = glm::vec3(glm::dvec3(angles.psi_rad, angles.theta_rad, angles.phi_rad));
  return state;
}

// What a receiver makes of it: the floats of the wire.
KinematicState AsReceived(const EntityState& state, double time_s) {
  KinematicState motion;
  motion.position_ecef = state.position_ecef;
  motion.velocity_mps = glm::dvec3(state.velocity_mps);
  motion.acceleration_mps2 = glm::dvec3(state.acceleration_mps2);
  motion.angular_velocity_radps = glm::dvec3(state.angular_velocity_radps);
  motion.orientation = {state.orientation_rad.x, state.orientation_rad.y, state.orientation_rad.z};
  motion.model = DeadReckoningModel(state.model);
  motion.time_s = time_s;
  return motion;
}

double AngleBetween(const glm::dmat3& a, const glm::dmat3& b) {
  const double trace = glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

}  // namespace

Result<TrafficStream> TrafficStream::Make(const TrafficOptions& options) {
  constexpr double kFastest = 720;
  if (!(options.speed > 0 && options.speed <= kFastest)) {
    return Status::Error("speed {}: it must be over 0 and at most {}", options.speed, kFastest);
  }
  auto vehicles = options.flights.empty() ? MakeVehicles(options.scenario, options.entities, options.seed)
                                          : ReadFlights(options.flights, options.speed, options.flights_from_s);
  if (!vehicles.ok()) return vehicles.status();
  if (!(options.rate_pdus_per_s >= 0 && options.rate_pdus_per_s <= 1e6)) {
    return Status::Error("rate {} PDUs/s: it must be from 0 to 1,000,000", options.rate_pdus_per_s);
  }
  return TrafficStream(options, std::move(*vehicles));
}

TrafficStream::TrafficStream(const TrafficOptions& options, std::vector<Vehicle> vehicles)
    : options_(options), vehicles_(std::move(vehicles)), sent_(vehicles_.size()) {
  for (KinematicState& state : sent_) state.time_s = -1;
}

EntityId TrafficStream::IdOf(size_t index) const {
  return {options_.site, static_cast<uint16_t>(options_.application + index / kPerApplication),
          static_cast<uint16_t>(1 + index % kPerApplication)};
}

double TrafficStream::NextStep() const {
  return static_cast<double>(steps_) * (options_.rate_pdus_per_s > 0 ? kRateStep_s : kStep_s);
}

std::span<const uint8_t> TrafficStream::Advance(double time_s) {
  bytes_.clear();
  engagements_.clear();
  while (NextStep() <= time_s) {
    Step(NextStep());
    ++steps_;
  }
  return bytes_;
}

void TrafficStream::Step(double time_s) {
  if (options_.rate_pdus_per_s > 0) {
    while (static_cast<double>(pdus_) <= time_s * options_.rate_pdus_per_s) {
      Emit(pdus_ % vehicles_.size(), static_cast<double>(pdus_) / options_.rate_pdus_per_s);
    }
    return;
  }
  if (options_.scenario == "dogfight" && options_.flights.empty()) Engage(time_s);
  for (size_t i = 0; i < vehicles_.size(); ++i) {
    const bool started = sent_[i].time_s >= 0;
    if (!IsThere(vehicles_[i], time_s)) {
      if (started) Emit(i, time_s, true);
      continue;
    }
    const bool looked_at = started ? (steps_ + i) % kStepsPerCheck == 0 : steps_ >= i % kStepsToStart;
    if (looked_at && (!started || IsDue(i, time_s))) Emit(i, time_s);
  }
}

bool TrafficStream::IsDue(size_t index, double time_s) const {
  const KinematicState& sent = sent_[index];
  if (time_s - sent.time_s >= options_.heartbeat_s - 0.5 * kStep_s) return true;
  const Pose believed = PoseAt(sent, time_s);
  const Pose truth = TruePose(vehicles_[index], time_s);
  return glm::length(believed.position_ecef - truth.position_ecef) > options_.position_threshold_m ||
         AngleBetween(believed.ecef_from_body, truth.ecef_from_body) > options_.orientation_threshold_rad;
}

PduHeader TrafficStream::HeaderAt(double time_s) const {
  const bool absolute = options_.utc_at_start_s >= 0;
  PduHeader header;
  header.version = options_.version;
  header.exercise = options_.exercise;
  header.timestamp = MakeTimestamp(time_s + (absolute ? options_.utc_at_start_s : 0.0), absolute);
  return header;
}

void TrafficStream::Emit(size_t index, double time_s, bool last) {
  const Vehicle& vehicle = vehicles_[index];
  EntityState state = ToEntityState(vehicle, IdOf(index), Report(vehicle, time_s));
  if (last) state.appearance |= kAppearanceDeactivated;
  sent_[index] = AsReceived(state, last ? -1 : time_s);
  const size_t at = bytes_.size();
  bytes_.resize(at + kEntityStateBytes);
  EncodePdu(HeaderAt(time_s), state, std::span(bytes_).subspan(at));
  ++pdus_;
}

// The one behind of each pair fires a burst every few seconds; every fourth bursts beside the one in front.
void TrafficStream::Engage(double time_s) {
  constexpr uint64_t kStepsPerBurst = 60, kBurstsPerHit = 4;
  constexpr double kMuzzle_mps = 950;
  constexpr size_t kLongest = 256;
  for (size_t pair = 0; 2 * pair + 1 < vehicles_.size(); ++pair) {
    const uint64_t step = steps_ + 7 * pair;
    if (step % kStepsPerBurst >= 6 || step % 2 != 0) continue;  // three rounds
    const Pose hunter = TruePose(vehicles_[2 * pair], time_s), hunted = TruePose(vehicles_[2 * pair + 1], time_s);
    const glm::dvec3 way = hunted.position_ecef - hunter.position_ecef;
    Fire fire;
    fire.firing = IdOf(2 * pair);
    fire.target = IdOf(2 * pair + 1);
    fire.event = {fire.firing.site, fire.firing.application, ++events_};
    fire.position_ecef = hunter.position_ecef + 8.0 * hunter.ecef_from_body[0];
    fire.descriptor = {{EntityType::kMunition, 1, 225, 2, 1, 0, 0}, 0, 0, 3, 600};
    fire.velocity_mps = glm::vec3(hunter.velocity_ecef_mps + kMuzzle_mps * glm::normalize(way));
    fire.range_m = static_cast<float>(glm::length(way));
    std::vector<uint8_t>& shot = engagements_.emplace_back(kLongest);
    shot.resize(EncodePdu(HeaderAt(time_s), fire, shot));
    if (step / kStepsPerBurst % kBurstsPerHit != 0 || step % kStepsPerBurst != 0) continue;
    Detonation hit;
    hit.firing = fire.firing;
    hit.target = fire.target;
    hit.event = fire.event;
    hit.velocity_mps = fire.velocity_mps;
    hit.position_ecef = hunted.position_ecef - 25.0 * hunted.ecef_from_body[0];
    hit.descriptor = fire.descriptor;
    hit.result = 2;  // beside the entity
    std::vector<uint8_t>& burst = engagements_.emplace_back(kLongest);
    burst.resize(EncodePdu(HeaderAt(time_s), hit, burst));
  }
}

}  // namespace belvedere::dis

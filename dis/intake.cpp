#include "dis/intake.h"

#include "dis/timestamp.h"

#include <glm/vec3.hpp>
#include <numeric>

namespace belvedere::dis {
namespace {

constexpr uint16_t kAll = 0xFFFF;

EulerAngles ToAngles(const glm::vec3& orientation_rad) {
  return {orientation_rad.x, orientation_rad.y, orientation_rad.z};
}

bool Matches(uint16_t wanted, uint16_t number) {
  return wanted == kAll || wanted == number;
}

}  // namespace

uint64_t IntakeCounters::rejected_total() const {
  return std::accumulate(rejected.begin(), rejected.end(), uint64_t{0});
}

uint64_t IntakeCounters::ignored_total() const {
  return std::accumulate(ignored_type.begin(), ignored_type.end(), ignored_version);
}

ObjectRecord ToRecord(const EntityState& state, double state_time_s, double received_s) {
  ObjectRecord record;
  record.id = state.id;
  record.type = state.type;
  record.force = state.force;
  record.appearance = state.appearance;
  record.marking = Marking::Sanitise(state.marking);
  record.received_s = received_s;
  KinematicState& motion = record.kinematics;
  motion.position_ecef = state.position_ecef;
  motion.velocity_mps = glm::dvec3(state.velocity_mps);
  motion.acceleration_mps2 = glm::dvec3(state.acceleration_mps2);
  motion.angular_velocity_radps = glm::dvec3(state.angular_velocity_radps);
  motion.orientation = ToAngles(state.orientation_rad);
  motion.model = DeadReckoningModel(state.model);
  motion.time_s = state_time_s;
  if (static_cast<uint8_t>(motion.model) != state.model && state.model != 0) record.flags = kObjectUnknownModel;
  for (size_t i = 0; i < state.parameters.size() && record.part_count < ObjectRecord::kMaxParts; ++i) {
    const VariableParameter part = state.parameters[i];
    if (part.record_type != 0) continue;
    record.part_array[record.part_count++] = {part.attached_to, part.part_type, part.value};
  }
  return record;
}

void Intake::Take(std::span<const uint8_t> datagram, double arrival_s, double utc_s) {
  ++counters_.datagrams;
  counters_.bytes += datagram.size();
  DatagramReader reader(datagram);
  for (Pdu pdu; reader.Next(pdu);) {
    ++counters_.received;
    const bool ours = !exercise_ || pdu.header.exercise == *exercise_;
    if (pdu.verdict == Verdict::kRejected) {
      ++counters_.rejected[static_cast<size_t>(pdu.rejection)];
    } else if (pdu.verdict == Verdict::kIgnoredVersion) {
      ++counters_.ignored_version;
    } else if (!ours) {
      ++counters_.filtered;
    } else if (pdu.verdict == Verdict::kIgnoredType) {
      ++counters_.ignored_type[pdu.header.type];
    } else {
      ++counters_.accepted;
      Apply(pdu, arrival_s, utc_s);
    }
  }
}

void Intake::Apply(const Pdu& pdu, double arrival_s, double utc_s) {
  if (const auto* state = std::get_if<EntityState>(&pdu.body)) {
    table_.Put(ToRecord(*state, StateTime(pdu.header.timestamp, arrival_s, utc_s), arrival_s));
  } else if (const auto* update = std::get_if<EntityStateUpdate>(&pdu.body)) {
    ObjectChange change;
    change.position_ecef = update->position_ecef;
    change.velocity_mps = glm::dvec3(update->velocity_mps);
    change.orientation = ToAngles(update->orientation_rad);
    change.appearance = update->appearance;
    change.time_s = StateTime(pdu.header.timestamp, arrival_s, utc_s);
    if (!table_.Change(update->id, change, arrival_s)) ++counters_.unknown_updates;
  } else if (const auto* remove = std::get_if<RemoveEntity>(&pdu.body)) {
    Remove(remove->removed);
  }
}

void Intake::Remove(const EntityId& removed) {
  if (removed.site != kAll && removed.application != kAll && removed.entity != kAll) {
    table_.Remove(removed);
    return;
  }
  for (const EntityId& id : table_.Ids()) {
    const bool matches = Matches(removed.site, id.site) && Matches(removed.application, id.application) &&
                         Matches(removed.entity, id.entity);
    if (matches) table_.Remove(id);
  }
}

}  // namespace belvedere::dis

#include "dis/intake.h"

#include "dis/engagement_events.h"

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

// Whether something is attached to the entity there. Before version 7 the second byte only counted changes.
bool Hangs(const VariableParameter& part, uint8_t version) {
  constexpr uint8_t kDetached = 1;
  constexpr uint32_t kLastStation = 0xFFFF;
  if (part.record_type != VariableParameter::kAttachedPart || part.attached_to != 0) return false;
  if (part.part_type == 0 || part.part_type > kLastStation || part.attached.kind == 0) return false;
  return version < 7 || part.change != kDetached;
}

}  // namespace

uint64_t IntakeCounters::rejected_total() const {
  return std::accumulate(rejected.begin(), rejected.end(), uint64_t{0});
}

uint64_t IntakeCounters::refused_total() const {
  const uint64_t all = std::accumulate(refused.begin(), refused.end(), uint64_t{0});
  return all - refused[static_cast<size_t>(Refusal::kSource)];
}

uint64_t IntakeCounters::ignored_total() const {
  return std::accumulate(ignored_type.begin(), ignored_type.end(), ignored_version);
}

ObjectRecord ToRecord(const EntityState& state, uint8_t version, double state_time_s, double received_s) {
  ObjectRecord record;
  record.protocol_version = version;
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
  for (size_t i = 0; i < state.parameters.size(); ++i) {
    const VariableParameter part = state.parameters[i];
    if (part.record_type == VariableParameter::kArticulatedPart && record.part_count < ObjectRecord::kMaxParts) {
      record.part_array[record.part_count++] = {part.attached_to, part.part_type, part.value};
    }
    if (Hangs(part, version) && record.attached_count < ObjectRecord::kMaxParts) {
      record.attached_array[record.attached_count++] = {static_cast<uint16_t>(part.part_type), part.attached};
    }
  }
  return record;
}

void Intake::Take(std::span<const uint8_t> datagram, const Arrival& arrival) {
  ++counters_.datagrams;
  counters_.bytes += datagram.size();
  if (!admission_.AdmitsSource(arrival.from)) {
    ++counters_.refused[static_cast<size_t>(Refusal::kSource)];
    return;
  }
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
    } else if (const std::optional<Refusal> refusal = Apply(pdu, arrival)) {
      ++counters_.refused[static_cast<size_t>(*refusal)];
    } else {
      ++counters_.accepted;
    }
  }
}

std::optional<Refusal> Intake::Apply(const Pdu& pdu, const Arrival& arrival) {
  if (!admission_.AdmitsPdu(arrival.from.host(), arrival.time_s)) return Refusal::kRate;
  if (const auto* state = std::get_if<EntityState>(&pdu.body)) return Apply(*state, pdu.header, arrival);
  if (const auto* update = std::get_if<EntityStateUpdate>(&pdu.body)) return Apply(*update, pdu.header, arrival);
  if (const auto* fire = std::get_if<Fire>(&pdu.body)) {
    for (const SceneEvent& event : EventsOf(*fire, arrival.time_s)) table_.AddEvent(event);
  }
  if (const auto* detonation = std::get_if<Detonation>(&pdu.body)) {
    for (const SceneEvent& event : EventsOf(*detonation, arrival.time_s, scorch_s_)) table_.AddEvent(event);
  }
  if (const auto* collision = std::get_if<Collision>(&pdu.body)) {
    if (const auto issuing = table_.Find(collision->issuing)) {
      table_.AddEvent(EventOf(*collision, issuing->kinematics, arrival.time_s));
    }
  }
  if (const auto* remove = std::get_if<RemoveEntity>(&pdu.body))
    return Obey(Command::kRemove, remove->removed, arrival);
  if (const auto* stop = std::get_if<StopFreeze>(&pdu.body)) return Obey(Command::kHold, stop->receiving, arrival);
  if (const auto* start = std::get_if<StartResume>(&pdu.body))
    return Obey(Command::kRelease, start->receiving, arrival);
  return std::nullopt;
}

double Intake::StateTime(const EntityId& id, uint32_t timestamp, const Arrival& arrival) {
  const SenderClocks::Sender sender{arrival.from.host(), id.site, id.application};
  return clocks_.StateTime(sender, timestamp, arrival.time_s, arrival.utc_s);
}

std::optional<Refusal> Intake::Apply(const EntityState& state, const PduHeader& header, const Arrival& arrival) {
  const AdmissionOptions& options = admission_.options();
  if (options.refuse_absurd && PositionFlags(state.position_ecef) != 0) return Refusal::kAbsurd;
  const uint64_t host = arrival.from.host();
  if (options.new_entities_per_s > 0 && !table_.Find(state.id) && !admission_.AdmitsNewEntity(host, arrival.time_s)) {
    return Refusal::kNewEntity;
  }
  ObjectRecord record = ToRecord(state, header.version, StateTime(state.id, header.timestamp, arrival), arrival.time_s);
  record.source = host;
  table_.Put(record);
  return std::nullopt;
}

std::optional<Refusal> Intake::Apply(const EntityStateUpdate& update, const PduHeader& header, const Arrival& arrival) {
  if (admission_.options().refuse_absurd && PositionFlags(update.position_ecef) != 0) return Refusal::kAbsurd;
  ObjectChange change;
  change.position_ecef = update.position_ecef;
  change.velocity_mps = glm::dvec3(update.velocity_mps);
  change.orientation = ToAngles(update.orientation_rad);
  change.appearance = update.appearance;
  change.time_s = StateTime(update.id, header.timestamp, arrival);
  if (!table_.Change(update.id, change, arrival.time_s)) ++counters_.unknown_updates;
  return std::nullopt;
}

std::optional<Refusal> Intake::Obey(Command command, const EntityId& named, const Arrival& arrival) {
  const bool one = named.site != kAll && named.application != kAll && named.entity != kAll;
  bool refused = false;
  for (const EntityId& id : one ? std::vector<EntityId>{named} : table_.Ids()) {
    const bool matches =
        Matches(named.site, id.site) && Matches(named.application, id.application) && Matches(named.entity, id.entity);
    if (!matches) continue;
    const std::optional<ObjectRecord> known = table_.Find(id);
    if (!known) continue;
    if (!admission_.AdmitsCommand(arrival.from, known->source)) {
      refused = true;
      continue;
    }
    switch (command) {
      case Command::kRemove: table_.Remove(id); break;
      case Command::kHold: table_.Hold(id, arrival.time_s); break;
      case Command::kRelease: table_.Release(id, arrival.time_s); break;
    }
  }
  return refused ? std::optional(Refusal::kStranger) : std::nullopt;
}

}  // namespace belvedere::dis

#include "dis/pdu_json.h"

#include "dis/timestamp.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace belvedere::dis {
namespace {

using Json = nlohmann::ordered_json;

template <typename Vector>
Json Triple(const Vector& v) {
  return Json::array({v.x, v.y, v.z});
}

Json Descriptor(const MunitionDescriptor& descriptor) {
  return {{"type", descriptor.type.ToString()},
          {"warhead", descriptor.warhead},
          {"fuse", descriptor.fuse},
          {"quantity", descriptor.quantity},
          {"rate", descriptor.rate}};
}

Json Parts(const VariableParameters& parameters) {
  Json parts = Json::array();
  for (size_t i = 0; i < parameters.size(); ++i) {
    const VariableParameter parameter = parameters[i];
    Json part = {{"record_type", parameter.record_type}};
    if (parameter.record_type <= VariableParameter::kAttachedPart) {
      part["change"] = parameter.change;
      part["attached_to"] = parameter.attached_to;
    }
    if (parameter.record_type == VariableParameter::kArticulatedPart) {
      part["part_type"] = parameter.part_type;
      part["value"] = std::isfinite(parameter.value) ? Json(parameter.value) : Json(nullptr);
    } else if (parameter.record_type == VariableParameter::kAttachedPart) {
      part["station"] = parameter.part_type;
      part["entity_type"] = parameter.attached.ToString();
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

void AddBody(Json&, const std::monostate&) {}

void AddBody(Json& line, const EntityState& state) {
  line["entity"] = state.id.ToString();
  line["force"] = state.force;
  line["entity_type"] = state.type.ToString();
  line["alternative_type"] = state.alternative_type.ToString();
  line["position_m"] = Triple(state.position_ecef);
  line["velocity_mps"] = Triple(state.velocity_mps);
  line["orientation_rad"] = Triple(state.orientation_rad);
  line["drm"] = state.model;
  line["acceleration_mps2"] = Triple(state.acceleration_mps2);
  line["angular_velocity_radps"] = Triple(state.angular_velocity_radps);
  line["appearance"] = state.appearance;
  line["character_set"] = state.character_set;
  line["marking"] = Marking::Sanitise(state.marking).view();
  line["capabilities"] = state.capabilities;
  line["parts"] = Parts(state.parameters);
}

void AddBody(Json& line, const EntityStateUpdate& update) {
  line["entity"] = update.id.ToString();
  line["position_m"] = Triple(update.position_ecef);
  line["velocity_mps"] = Triple(update.velocity_mps);
  line["orientation_rad"] = Triple(update.orientation_rad);
  line["appearance"] = update.appearance;
  line["parts"] = Parts(update.parameters);
}

// What Fire and Detonation say alike.
template <typename Engagement>
void AddParticipants(Json& line, const Engagement& engagement) {
  line["firing"] = engagement.firing.ToString();
  line["target"] = engagement.target.ToString();
  line["munition"] = engagement.munition.ToString();
  line["event"] = engagement.event.ToString();
}

void AddBody(Json& line, const Fire& fire) {
  AddParticipants(line, fire);
  line["fire_mission"] = fire.mission;
  line["position_m"] = Triple(fire.position_ecef);
  line["descriptor"] = Descriptor(fire.descriptor);
  line["velocity_mps"] = Triple(fire.velocity_mps);
  line["range_m"] = fire.range_m;
}

void AddBody(Json& line, const Detonation& detonation) {
  AddParticipants(line, detonation);
  line["velocity_mps"] = Triple(detonation.velocity_mps);
  line["position_m"] = Triple(detonation.position_ecef);
  line["descriptor"] = Descriptor(detonation.descriptor);
  line["position_in_target_m"] = Triple(detonation.position_in_target_m);
  line["result"] = detonation.result;
  line["parts"] = Parts(detonation.parameters);
}

void AddBody(Json& line, const RemoveEntity& remove) {
  line["originating"] = remove.originating.ToString();
  line["entity"] = remove.removed.ToString();
  line["request"] = remove.request;
}

void AddBody(Json& line, const CreateEntity& create) {
  line["originating"] = create.originating.ToString();
  line["entity"] = create.created.ToString();
  line["request"] = create.request;
}

void AddBody(Json& line, const Collision& collision) {
  line["issuing"] = collision.issuing.ToString();
  line["colliding"] = collision.colliding.ToString();
  line["event"] = collision.event.ToString();
  line["collision_type"] = collision.type;
  line["velocity_mps"] = Triple(collision.velocity_mps);
  line["mass_kg"] = collision.mass_kg;
  line["position_in_entity_m"] = Triple(collision.position_in_entity_m);
}

Json Clock(const ClockTime& time) {
  return {{"hours", time.hours}, {"past_hour_s", SecondsPastHour(time.past_hour)}};
}

void AddBody(Json& line, const StartResume& start) {
  line["originating"] = start.originating.ToString();
  line["entity"] = start.receiving.ToString();
  line["real_world"] = Clock(start.real_world);
  line["simulation"] = Clock(start.simulation);
  line["request"] = start.request;
}

void AddBody(Json& line, const StopFreeze& stop) {
  line["originating"] = stop.originating.ToString();
  line["entity"] = stop.receiving.ToString();
  line["real_world"] = Clock(stop.real_world);
  line["reason"] = stop.reason;
  line["frozen_behaviour"] = stop.frozen_behaviour;
  line["request"] = stop.request;
}

Json Beam(const EmitterBeam& beam) {
  return {{"number", beam.number},
          {"parameter_index", beam.parameter_index},
          {"frequency_hz", beam.frequency_hz},
          {"effective_power_dbm", beam.effective_power_dbm},
          {"pulse_rate_hz", beam.pulse_rate_hz},
          {"azimuth_rad", beam.azimuth_rad},
          {"azimuth_sweep_rad", beam.azimuth_sweep_rad},
          {"elevation_rad", beam.elevation_rad},
          {"elevation_sweep_rad", beam.elevation_sweep_rad},
          {"function", beam.function},
          {"targets", beam.target_count}};
}

void AddBody(Json& line, const ElectromagneticEmission& emission) {
  line["entity"] = emission.emitting.ToString();
  line["event"] = emission.event.ToString();
  line["state_update"] = emission.state_update;
  Json systems = Json::array();
  EmitterReader reader(emission);
  for (EmitterSystem system; reader.NextSystem(system);) {
    Json one = {{"name", system.name},
                {"function", system.function},
                {"number", system.number},
                {"position_in_entity_m", Triple(system.position_in_entity_m)}};
    Json beams = Json::array();
    for (EmitterBeam beam; reader.NextBeam(beam);) beams.push_back(Beam(beam));
    one["beams"] = std::move(beams);
    systems.push_back(std::move(one));
  }
  line["systems"] = std::move(systems);
}

void AddBody(Json& line, const Designator& designator) {
  line["designating"] = designator.designating.ToString();
  line["designated"] = designator.designated.ToString();
  line["code_name"] = designator.code_name;
  line["code"] = designator.code;
  line["power_w"] = designator.power_w;
  line["wavelength_um"] = designator.wavelength_um;
  line["spot_in_target_m"] = Triple(designator.spot_in_target_m);
  line["position_m"] = Triple(designator.spot_ecef);
  line["drm"] = designator.model;
  line["acceleration_mps2"] = Triple(designator.acceleration_mps2);
}

void AddBody(Json& line, const Transmitter& transmitter) {
  line["entity"] = transmitter.id.ToString();
  line["radio"] = transmitter.radio;
  line["radio_type"] = transmitter.radio_type.ToString();
  line["state"] = transmitter.state;
  line["input_source"] = transmitter.input_source;
  line["antenna_m"] = Triple(transmitter.antenna_ecef);
  line["antenna_in_entity_m"] = Triple(transmitter.antenna_in_entity_m);
  line["frequency_hz"] = transmitter.frequency_hz;
  line["bandwidth_hz"] = transmitter.bandwidth_hz;
  line["power_dbm"] = transmitter.power_dbm;
}

void AddBody(Json& line, const Signal& signal) {
  line["entity"] = signal.id.ToString();
  line["radio"] = signal.radio;
  line["encoding_scheme"] = signal.encoding_scheme;
  line["tdl_type"] = signal.tdl_type;
  line["sample_rate_hz"] = signal.sample_rate_hz;
  line["data_bits"] = signal.data_bits;
  line["samples"] = signal.samples;
}

void AddBody(Json& line, const EnvironmentalProcess& process) {
  line["entity"] = process.id.ToString();
  line["environment_type"] = process.type.ToString();
  line["model"] = process.model;
  line["process_status"] = process.status;
  line["records"] = process.record_count;
  line["sequence"] = process.sequence;
}

void AddBody(Json& line, const GriddedData& grid) {
  line["entity"] = grid.id.ToString();
  line["field"] = grid.field;
  line["pdu_number"] = grid.pdu_number;
  line["pdu_total"] = grid.pdu_total;
  line["coordinate_system"] = grid.coordinate_system;
  line["axes"] = grid.axis_count;
  line["environment_type"] = grid.type.ToString();
  line["orientation_rad"] = Triple(grid.orientation_rad);
  line["values"] = grid.value_count;
}

}  // namespace

std::string PduJson(uint64_t frame, const Pdu& pdu) {
  Json line = {{"frame", frame}, {"offset", pdu.offset}};
  if (pdu.verdict == Verdict::kRejected) {
    line["rejected"] = RejectionText(pdu.rejection);
    return line.dump();
  }
  const PduHeader& header = pdu.header;
  line["version"] = header.version;
  line["exercise"] = header.exercise;
  line["type"] = header.type;
  line["family"] = header.family;
  line["timestamp"] = header.timestamp;
  line["timestamp_s"] = SecondsPastHour(header.timestamp);
  line["length"] = header.length;
  if (header.version >= 7) line["status"] = header.status;
  if (pdu.verdict == Verdict::kIgnoredVersion) line["ignored"] = "protocol version";
  std::visit([&](const auto& body) { AddBody(line, body); }, pdu.body);
  return line.dump();
}

}  // namespace belvedere::dis

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
    if (parameter.record_type <= 1) {
      part["change"] = parameter.change;
      part["attached_to"] = parameter.attached_to;
    }
    if (parameter.record_type == 0) {
      part["part_type"] = parameter.part_type;
      part["value"] = std::isfinite(parameter.value) ? Json(parameter.value) : Json(nullptr);
    } else if (parameter.record_type == 1) {
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

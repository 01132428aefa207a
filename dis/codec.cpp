#include "dis/codec.h"

#include "dis/wire.h"
#include "runtime/base/status.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere::dis {
namespace {

constexpr uint8_t kEntityInformationFamily = 1;
constexpr uint8_t kSimulationManagementFamily = 5;

PduHeader ReadHeader(WireReader& in) {
  PduHeader header;
  header.version = in.U8();
  header.exercise = in.U8();
  header.type = in.U8();
  header.family = in.U8();
  header.timestamp = in.U32();
  header.length = in.U16();
  header.status = header.version >= 7 ? in.U8() : uint8_t{0};
  return header;
}

void WriteHeader(WireWriter& out, const PduHeader& header) {
  out.U8(header.version);
  out.U8(header.exercise);
  out.U8(header.type);
  out.U8(header.family);
  out.U32(header.timestamp);
  out.U16(header.length);
  out.U8(header.version >= 7 ? header.status : uint8_t{0});
  out.U8(0);
}

template <typename Vector>
bool Finite(const Vector& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Rejection CheckPosition(const glm::dvec3& ecef) {
  if (!Finite(ecef)) return Rejection::kNotFinite;
  const double farthest = std::max({std::abs(ecef.x), std::abs(ecef.y), std::abs(ecef.z)});
  return farthest > kFarthestPosition_m ? Rejection::kPositionOutOfRange : Rejection::kNone;
}

bool NamesOneEntity(const EntityId& id) {
  constexpr uint16_t kAll = 0xFFFF, kRequestAssign = 0xFFFE;
  return id.entity != 0 && id.entity != kRequestAssign && id.site != kAll && id.application != kAll &&
         id.entity != kAll;
}

// Checks what all kinds of entity state have.
Rejection CheckState(const EntityId& id, const glm::dvec3& position, const glm::vec3& velocity,
                     const glm::vec3& orientation) {
  if (!NamesOneEntity(id)) return Rejection::kBadEntityId;
  if (!Finite(velocity) || !Finite(orientation)) return Rejection::kNotFinite;
  return CheckPosition(position);
}

// The `count` variable parameters from the reader's place on; false when the PDU has no room for them.
bool ReadParameters(std::span<const uint8_t> pdu, const WireReader& in, size_t count, VariableParameters& parameters) {
  const size_t bytes = count * VariableParameters::kBytes;
  if (bytes > pdu.size() - in.at()) return false;
  parameters = VariableParameters(pdu.subspan(in.at(), bytes));
  return true;
}

MunitionDescriptor ReadDescriptor(WireReader& in) {
  MunitionDescriptor descriptor;
  descriptor.type = in.Type();
  descriptor.warhead = in.U16();
  descriptor.fuse = in.U16();
  descriptor.quantity = in.U16();
  descriptor.rate = in.U16();
  return descriptor;
}

// Every Read function: REQUIRES that `pdu` has the fixed bytes of its type.
Rejection ReadEntityState(std::span<const uint8_t> pdu, EntityState& state) {
  WireReader in(pdu, kHeaderBytes);
  state.id = in.Id();
  state.force = in.U8();
  const size_t parameters = in.U8();
  state.type = in.Type();
  state.alternative_type = in.Type();
  state.velocity_mps = in.Vec3();
  state.position_ecef = in.DVec3();
  state.orientation_rad = in.Vec3();
  state.appearance = in.U32();
  state.model = in.U8();
  std::ranges::copy(in.Bytes(state.model_parameters.size()), state.model_parameters.begin());
  state.acceleration_mps2 = in.Vec3();
  state.angular_velocity_radps = in.Vec3();
  state.character_set = in.U8();
  std::ranges::copy(in.Bytes(state.marking.size()), state.marking.begin());
  state.capabilities = in.U32();
  if (!ReadParameters(pdu, in, parameters, state.parameters)) return Rejection::kParametersDoNotFit;
  const DeadReckoning model = DeadReckoningModel(state.model);
  if (!Finite(state.acceleration_mps2)) {
    if (ModelAccelerates(model)) return Rejection::kNotFinite;
    state.acceleration_mps2 = glm::vec3(0.0f);
  }
  if (!Finite(state.angular_velocity_radps)) {
    if (ModelRotates(model)) return Rejection::kNotFinite;
    state.angular_velocity_radps = glm::vec3(0.0f);
  }
  return CheckState(state.id, state.position_ecef, state.velocity_mps, state.orientation_rad);
}

Rejection ReadEntityStateUpdate(std::span<const uint8_t> pdu, EntityStateUpdate& update) {
  WireReader in(pdu, kHeaderBytes);
  update.id = in.Id();
  in.Skip(1);
  const size_t parameters = in.U8();
  update.velocity_mps = in.Vec3();
  update.position_ecef = in.DVec3();
  update.orientation_rad = in.Vec3();
  update.appearance = in.U32();
  if (!ReadParameters(pdu, in, parameters, update.parameters)) return Rejection::kParametersDoNotFit;
  return CheckState(update.id, update.position_ecef, update.velocity_mps, update.orientation_rad);
}

Rejection ReadFire(std::span<const uint8_t> pdu, Fire& fire) {
  WireReader in(pdu, kHeaderBytes);
  fire.firing = in.Id();
  fire.target = in.Id();
  fire.munition = in.Id();
  fire.event = in.Id();
  fire.mission = in.U32();
  fire.position_ecef = in.DVec3();
  fire.descriptor = ReadDescriptor(in);
  fire.velocity_mps = in.Vec3();
  fire.range_m = in.F32();
  if (!Finite(fire.velocity_mps) || !std::isfinite(fire.range_m)) return Rejection::kNotFinite;
  return CheckPosition(fire.position_ecef);
}

Rejection ReadDetonation(std::span<const uint8_t> pdu, Detonation& detonation) {
  WireReader in(pdu, kHeaderBytes);
  detonation.firing = in.Id();
  detonation.target = in.Id();
  detonation.munition = in.Id();
  detonation.event = in.Id();
  detonation.velocity_mps = in.Vec3();
  detonation.position_ecef = in.DVec3();
  detonation.descriptor = ReadDescriptor(in);
  detonation.position_in_target_m = in.Vec3();
  detonation.result = in.U8();
  const size_t parameters = in.U8();
  in.Skip(2);
  if (!ReadParameters(pdu, in, parameters, detonation.parameters)) return Rejection::kParametersDoNotFit;
  if (!Finite(detonation.velocity_mps) || !Finite(detonation.position_in_target_m)) return Rejection::kNotFinite;
  return CheckPosition(detonation.position_ecef);
}

Rejection ReadRemoveEntity(std::span<const uint8_t> pdu, RemoveEntity& remove) {
  WireReader in(pdu, kHeaderBytes);
  remove.originating = in.Id();
  remove.removed = in.Id();
  remove.request = in.U32();
  return Rejection::kNone;
}

template <typename Body>
void ReadBody(std::span<const uint8_t> bytes, size_t fixed_bytes, Rejection (*read)(std::span<const uint8_t>, Body&),
              Pdu& pdu) {
  pdu.rejection = bytes.size() < fixed_bytes ? Rejection::kShortBody : read(bytes, pdu.body.emplace<Body>());
  pdu.verdict = pdu.rejection == Rejection::kNone ? Verdict::kDecoded : Verdict::kRejected;
  if (pdu.verdict == Verdict::kRejected) pdu.body = std::monostate();
}

void ReadPdu(std::span<const uint8_t> bytes, Pdu& pdu) {
  if (pdu.header.version < 5 || pdu.header.version > 7) {
    pdu.verdict = Verdict::kIgnoredVersion;
    return;
  }
  switch (pdu.header.type) {
    case kEntityState: return ReadBody(bytes, kEntityStateBytes, &ReadEntityState, pdu);
    case kEntityStateUpdate: return ReadBody(bytes, kEntityStateUpdateBytes, &ReadEntityStateUpdate, pdu);
    case kFire: return ReadBody(bytes, kFireBytes, &ReadFire, pdu);
    case kDetonation: return ReadBody(bytes, kDetonationBytes, &ReadDetonation, pdu);
    case kRemoveEntity: return ReadBody(bytes, kRemoveEntityBytes, &ReadRemoveEntity, pdu);
    default: pdu.verdict = Verdict::kIgnoredType;
  }
}

}  // namespace

std::string_view RejectionText(Rejection rejection) {
  constexpr std::array<std::string_view, static_cast<size_t>(Rejection::kCount)> kTexts = {
      "none",
      "header shorter than 12 bytes",
      "length less than a header",
      "length more than the datagram holds",
      "length less than this type of PDU takes",
      "variable parameters do not fit",
      "value not finite",
      "position out of range",
      "entity id names no single entity",
  };
  return kTexts[static_cast<size_t>(rejection)];
}

VariableParameter VariableParameters::operator[](size_t index) const {
  WireReader in(bytes_.subspan(index * kBytes, kBytes));
  VariableParameter parameter;
  parameter.record_type = in.U8();
  if (parameter.record_type > 1) return parameter;
  parameter.change = in.U8();
  parameter.attached_to = in.U16();
  parameter.part_type = in.U32();
  if (parameter.record_type == 0) {
    parameter.value = in.F32();
  } else {
    parameter.attached = in.Type();
  }
  return parameter;
}

bool DatagramReader::Next(Pdu& pdu) {
  const std::span<const uint8_t> rest = datagram_.subspan(offset_);
  if (done_) return false;
  if (offset_ > 0) {
    const bool padding =
        rest.size() < kHeaderBytes || std::ranges::all_of(rest, [](uint8_t byte) { return byte == 0; });
    if (padding) return false;
  }
  pdu = Pdu{};
  pdu.offset = offset_;
  done_ = true;
  if (rest.size() < kHeaderBytes) {
    pdu.rejection = Rejection::kShortHeader;
    return true;
  }
  WireReader in(rest);
  pdu.header = ReadHeader(in);
  if (pdu.header.length < kHeaderBytes) {
    pdu.rejection = Rejection::kLengthUnderHeader;
  } else if (pdu.header.length > rest.size()) {
    pdu.rejection = Rejection::kLengthOverDatagram;
  } else {
    ReadPdu(rest.first(pdu.header.length), pdu);
    offset_ += pdu.header.length;
    done_ = false;
  }
  return true;
}

size_t EncodeEntityState(PduHeader header, const EntityState& state, std::span<uint8_t> out) {
  if (out.size() < kEntityStateBytes) return 0;
  header.type = kEntityState;
  header.family = kEntityInformationFamily;
  header.length = kEntityStateBytes;
  WireWriter writer(out);
  WriteHeader(writer, header);
  writer.Id(state.id);
  writer.U8(state.force);
  writer.U8(0);
  writer.Type(state.type);
  writer.Type(state.alternative_type);
  writer.Vec3(state.velocity_mps);
  writer.DVec3(state.position_ecef);
  writer.Vec3(state.orientation_rad);
  writer.U32(state.appearance);
  writer.U8(state.model);
  writer.Bytes(state.model_parameters);
  writer.Vec3(state.acceleration_mps2);
  writer.Vec3(state.angular_velocity_radps);
  writer.U8(state.character_set);
  writer.Bytes(state.marking);
  writer.U32(state.capabilities);
  return writer.at();
}

size_t EncodeRemoveEntity(PduHeader header, const RemoveEntity& remove, std::span<uint8_t> out) {
  if (out.size() < kRemoveEntityBytes) return 0;
  header.type = kRemoveEntity;
  header.family = kSimulationManagementFamily;
  header.length = kRemoveEntityBytes;
  WireWriter writer(out);
  WriteHeader(writer, header);
  writer.Id(remove.originating);
  writer.Id(remove.removed);
  writer.U32(remove.request);
  return writer.at();
}

}  // namespace belvedere::dis

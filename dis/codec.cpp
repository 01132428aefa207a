#include "dis/codec.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere::dis {
namespace {

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

// Check: what is wrong with the values of a body. An Entity State's accelerations that its model does not use are
// zeroed where they are not finite.
Rejection Check(EntityState& state) {
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

Rejection Check(const EntityStateUpdate& update) {
  return CheckState(update.id, update.position_ecef, update.velocity_mps, update.orientation_rad);
}

Rejection Check(const Fire& fire) {
  if (!Finite(fire.velocity_mps) || !std::isfinite(fire.range_m)) return Rejection::kNotFinite;
  return CheckPosition(fire.position_ecef);
}

Rejection Check(const Detonation& detonation) {
  if (!Finite(detonation.velocity_mps) || !Finite(detonation.position_in_target_m)) return Rejection::kNotFinite;
  return CheckPosition(detonation.position_ecef);
}

Rejection Check(const Collision& collision) {
  const bool finite = Finite(collision.velocity_mps) && Finite(collision.position_in_entity_m);
  return finite ? Rejection::kNone : Rejection::kNotFinite;
}

Rejection Check(const ElectromagneticEmission& emission) {
  EmitterReader reader(emission);
  EmitterSystem system;
  while (reader.NextSystem(system)) {
  }
  return reader.fits() ? Rejection::kNone : Rejection::kRecordsDoNotFit;
}

Rejection Check(const Designator& designator) {
  if (!Finite(designator.acceleration_mps2) || !Finite(designator.spot_in_target_m)) return Rejection::kNotFinite;
  return CheckPosition(designator.spot_ecef);
}

// Nothing of these is drawn at a place; their numbers are passed on as they came.
template <typename Body>
Rejection Check(const Body&) {
  return Rejection::kNone;
}

template <typename Body>
void ReadBody(std::span<const uint8_t> bytes, Pdu& pdu) {
  pdu.rejection = Rejection::kShortBody;
  if (bytes.size() >= PduTraits<Body>::kFixedBytes) {
    auto& body = pdu.body.emplace<Body>();
    WireReader wire(bytes, kHeaderBytes);
    Lay(wire, body);
    pdu.rejection = wire.fits() ? Check(body) : Rejection::kRecordsDoNotFit;
  }
  pdu.verdict = pdu.rejection == Rejection::kNone ? Verdict::kDecoded : Verdict::kRejected;
  if (pdu.verdict == Verdict::kRejected) pdu.body = std::monostate();
}

void ReadPdu(std::span<const uint8_t> bytes, Pdu& pdu) {
  if (pdu.header.version < 5 || pdu.header.version > 7) {
    pdu.verdict = Verdict::kIgnoredVersion;
    return;
  }
  switch (pdu.header.type) {
    case kEntityState: return ReadBody<EntityState>(bytes, pdu);
    case kEntityStateUpdate: return ReadBody<EntityStateUpdate>(bytes, pdu);
    case kFire: return ReadBody<Fire>(bytes, pdu);
    case kDetonation: return ReadBody<Detonation>(bytes, pdu);
    case kCollision: return ReadBody<Collision>(bytes, pdu);
    case kCreateEntity: return ReadBody<CreateEntity>(bytes, pdu);
    case kRemoveEntity: return ReadBody<RemoveEntity>(bytes, pdu);
    case kStartResume: return ReadBody<StartResume>(bytes, pdu);
    case kStopFreeze: return ReadBody<StopFreeze>(bytes, pdu);
    case kElectromagneticEmission: return ReadBody<ElectromagneticEmission>(bytes, pdu);
    case kDesignator: return ReadBody<Designator>(bytes, pdu);
    case kTransmitter: return ReadBody<Transmitter>(bytes, pdu);
    case kSignal: return ReadBody<Signal>(bytes, pdu);
    case kEnvironmentalProcess: return ReadBody<EnvironmentalProcess>(bytes, pdu);
    case kGriddedData: return ReadBody<GriddedData>(bytes, pdu);
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
      "variable parameters or records do not fit",
      "value not finite",
      "position out of range",
      "entity id names no single entity",
  };
  return kTexts[static_cast<size_t>(rejection)];
}

VariableParameter VariableParameters::operator[](size_t index) const {
  WireReader in(raw.bytes().subspan(index * kBytes, kBytes));
  VariableParameter parameter;
  in(parameter.record_type);
  if (parameter.record_type > VariableParameter::kAttachedPart) return parameter;
  in(parameter.change, parameter.attached_to, parameter.part_type);
  if (parameter.record_type == VariableParameter::kArticulatedPart) {
    in(parameter.value);
  } else {
    in(parameter.attached);
  }
  return parameter;
}

std::array<uint8_t, VariableParameters::kBytes> EncodeParameter(const VariableParameter& parameter) {
  BELVEDERE_CHECK(parameter.record_type <= VariableParameter::kAttachedPart);
  std::array<uint8_t, VariableParameters::kBytes> bytes{};
  WireWriter out(bytes);
  out(parameter.record_type, parameter.change, parameter.attached_to, parameter.part_type);
  if (parameter.record_type == VariableParameter::kArticulatedPart) {
    out(parameter.value);
  } else {
    out(parameter.attached);
  }
  return bytes;
}

bool EmitterReader::NextSystem(EmitterSystem& system) {
  EmitterBeam stepped_over;
  while (NextBeam(stepped_over)) {
  }
  if (systems_left_ == 0 || !wire_.fits()) return false;
  --systems_left_;
  system = {};
  Lay(wire_, system);
  beams_left_ = system.beam_count;
  return wire_.fits();
}

bool EmitterReader::NextBeam(EmitterBeam& beam) {
  if (beams_left_ == 0 || !wire_.fits()) return false;
  --beams_left_;
  beam = {};
  Lay(wire_, beam);
  return wire_.fits();
}

bool DatagramReader::Next(Pdu& pdu) {
  const std::span<const uint8_t> rest = datagram_.subspan(offset_);
  if (done_) return false;
  if (offset_ > 0) {
    const bool padding =
        rest.size() < kHeaderBytes || std::ranges::all_of(rest, [](uint8_t byte) { return byte == 0; });
    if (padding) return false;
  }
  pdu.offset = offset_;
  pdu.verdict = Verdict::kRejected;
  pdu.rejection = Rejection::kNone;
  pdu.header = {};
  pdu.body = std::monostate();
  done_ = true;
  if (rest.size() < kHeaderBytes) {
    pdu.rejection = Rejection::kShortHeader;
    return true;
  }
  WireReader in(rest);
  Lay(in, pdu.header);
  if (pdu.header.version < 7) pdu.header.status = 0;
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

template <typename Body>
size_t EncodePdu(PduHeader header, const Body& body, std::span<uint8_t> out) {
  using Traits = PduTraits<Body>;
  if (out.size() < Traits::kFixedBytes) return 0;
  WireWriter writer(out.subspan(kHeaderBytes));
  Lay(writer, body);
  const size_t length = kHeaderBytes + writer.at();
  if (!writer.fits() || length > UINT16_MAX) return 0;
  header.type = Traits::kType;
  header.family = Traits::kFamily;
  header.length = static_cast<uint16_t>(length);
  if (header.version < 7) header.status = 0;
  WireWriter head(out);
  Lay(head, header);
  return length;
}

template size_t EncodePdu(PduHeader, const EntityState&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const EntityStateUpdate&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const Fire&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const Detonation&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const Collision&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const CreateEntity&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const RemoveEntity&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const StartResume&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const StopFreeze&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const ElectromagneticEmission&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const Designator&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const Transmitter&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const Signal&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const EnvironmentalProcess&, std::span<uint8_t>);
template size_t EncodePdu(PduHeader, const GriddedData&, std::span<uint8_t>);

}  // namespace belvedere::dis

// The fields of every PDU in the order of the wire: one list that reads with a WireReader and writes with a WireWriter
// (wire.h). Offsets and sizes as in IEEE 1278.1; kFixedBytes counts the header's 12 bytes and all that has always the
// same size.
//
// Threads: pure functions.
#pragma once

#include "dis/pdu.h"

namespace belvedere::dis {

inline constexpr size_t kHeaderBytes = 12;

enum PduFamily : uint8_t {
  kEntityInformation = 1,
  kWarfare = 2,
  kRadioCommunications = 4,
  kSimulationManagement = 5,
  kDistributedEmission = 6,
  kSyntheticEnvironment = 9,
};

// What the header of each says, and how many bytes it has at least.
template <typename Body>
struct PduTraits;
#define BELVEDERE_PDU(BODY, FAMILY, BYTES)             \
  template <>                                          \
  struct PduTraits<BODY> {                             \
    static constexpr uint8_t kType = PduType::k##BODY; \
    static constexpr uint8_t kFamily = FAMILY;         \
    static constexpr size_t kFixedBytes = BYTES;       \
  }
BELVEDERE_PDU(EntityState, kEntityInformation, 144);
BELVEDERE_PDU(EntityStateUpdate, kEntityInformation, 72);
BELVEDERE_PDU(Collision, kEntityInformation, 60);
BELVEDERE_PDU(Fire, kWarfare, 96);
BELVEDERE_PDU(Detonation, kWarfare, 104);
BELVEDERE_PDU(CreateEntity, kSimulationManagement, 28);
BELVEDERE_PDU(RemoveEntity, kSimulationManagement, 28);
BELVEDERE_PDU(StartResume, kSimulationManagement, 44);
BELVEDERE_PDU(StopFreeze, kSimulationManagement, 40);
BELVEDERE_PDU(ElectromagneticEmission, kDistributedEmission, 28);
BELVEDERE_PDU(Designator, kDistributedEmission, 88);
BELVEDERE_PDU(Transmitter, kRadioCommunications, 104);
BELVEDERE_PDU(Signal, kRadioCommunications, 32);
BELVEDERE_PDU(EnvironmentalProcess, kSyntheticEnvironment, 32);
BELVEDERE_PDU(GriddedData, kSyntheticEnvironment, 64);
#undef BELVEDERE_PDU

// Field<Body> is Body for a reader and const Body for a writer.
template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<PduHeader>& h) {
  wire(h.version, h.exercise, h.type, h.family, h.timestamp, h.length, h.status);
  wire.Skip(1);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<EntityState>& s) {
  wire(s.id, s.force);
  wire.template Size<uint8_t>(s.parameters.raw, VariableParameters::kBytes);
  wire(s.type, s.alternative_type, s.velocity_mps, s.position_ecef, s.orientation_rad, s.appearance);
  wire(s.model, s.model_parameters, s.acceleration_mps2, s.angular_velocity_radps);
  wire(s.character_set, s.marking, s.capabilities);
  wire.Content(s.parameters.raw);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<EntityStateUpdate>& u) {
  wire(u.id);
  wire.Skip(1);
  wire.template Size<uint8_t>(u.parameters.raw, VariableParameters::kBytes);
  wire(u.velocity_mps, u.position_ecef, u.orientation_rad, u.appearance);
  wire.Content(u.parameters.raw);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<MunitionDescriptor>& d) {
  wire(d.type, d.warhead, d.fuse, d.quantity, d.rate);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<Fire>& f) {
  wire(f.firing, f.target, f.munition, f.event, f.mission, f.position_ecef);
  Lay(wire, f.descriptor);
  wire(f.velocity_mps, f.range_m);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<Detonation>& d) {
  wire(d.firing, d.target, d.munition, d.event, d.velocity_mps, d.position_ecef);
  Lay(wire, d.descriptor);
  wire(d.position_in_target_m, d.result);
  wire.template Size<uint8_t>(d.parameters.raw, VariableParameters::kBytes);
  wire.Skip(2);
  wire.Content(d.parameters.raw);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<Collision>& c) {
  wire(c.issuing, c.colliding, c.event, c.type);
  wire.Skip(1);
  wire(c.velocity_mps, c.mass_kg, c.position_in_entity_m);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<CreateEntity>& c) {
  wire(c.originating, c.created, c.request);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<RemoveEntity>& r) {
  wire(r.originating, r.removed, r.request);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<ClockTime>& t) {
  wire(t.hours, t.past_hour);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<StartResume>& s) {
  wire(s.originating, s.receiving);
  Lay(wire, s.real_world);
  Lay(wire, s.simulation);
  wire(s.request);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<StopFreeze>& s) {
  wire(s.originating, s.receiving);
  Lay(wire, s.real_world);
  wire(s.reason, s.frozen_behaviour);
  wire.Skip(2);
  wire(s.request);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<ElectromagneticEmission>& e) {
  wire(e.emitting, e.event, e.state_update, e.system_count);
  wire.Skip(2);
  wire.Rest(e.systems);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<EmitterSystem>& s) {
  wire.Skip(1);  // length in words; 0 where it is too long to say, so nobody can go by it
  wire(s.beam_count);
  wire.Skip(2);
  wire(s.name, s.function, s.number, s.position_in_entity_m);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<EmitterBeam>& b) {
  wire.Skip(1);  // length in words
  wire(b.number, b.parameter_index, b.frequency_hz, b.frequency_range_hz, b.effective_power_dbm, b.pulse_rate_hz,
       b.pulse_width_us, b.azimuth_rad, b.azimuth_sweep_rad, b.elevation_rad, b.elevation_sweep_rad, b.sweep_sync);
  wire(b.function, b.target_count, b.high_density, b.status, b.jamming_mode);
  wire.Content(b.targets, size_t{8} * b.target_count);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<Designator>& d) {
  wire(d.designating, d.code_name, d.designated, d.code, d.power_w, d.wavelength_um, d.spot_in_target_m, d.spot_ecef);
  wire(d.model);
  wire.Skip(3);
  wire(d.acceleration_mps2);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<Transmitter>& t) {
  wire(t.id, t.radio, t.radio_type, t.state, t.input_source, t.variable_count, t.antenna_ecef, t.antenna_in_entity_m);
  wire(t.pattern_type);
  wire.template Size<uint16_t>(t.antenna_pattern);
  wire(t.frequency_hz, t.bandwidth_hz, t.power_dbm, t.modulation, t.crypto_system, t.crypto_key);
  wire.template Size<uint8_t>(t.modulation_parameters);
  wire.Skip(3);
  wire.Content(t.modulation_parameters);
  wire.Content(t.antenna_pattern);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<Signal>& s) {
  wire(s.id, s.radio, s.encoding_scheme, s.tdl_type, s.sample_rate_hz, s.data_bits, s.samples);
  wire.Content(s.data, (size_t{s.data_bits} + 7) / 8);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<EnvironmentalProcess>& e) {
  wire(e.id, e.type, e.model, e.status, e.record_count, e.sequence);
  wire.Rest(e.records);
}

template <typename Wire>
void Lay(Wire& wire, typename Wire::template Field<GriddedData>& g) {
  wire(g.id, g.field, g.pdu_number, g.pdu_total, g.coordinate_system, g.axis_count, g.constant_grid, g.type);
  wire(g.orientation_rad, g.sample_time, g.value_count, g.vector_dimension);
  wire.Skip(3);
  wire.Rest(g.grid);
}

}  // namespace belvedere::dis

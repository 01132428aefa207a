// The PDUs of DIS that Belvedere reads, as values. IEEE 1278.1-1995 (version 5), 1278.1A-1998 (6) and 1278.1-2012 (7)
// lay them out alike; pdu_layout.h lists their fields in the order of the wire, codec.h reads and writes them.
//
// Units:  as on the wire: metres, seconds, radians, hertz.
// Frames: positions ECEF; velocity and acceleration ECEF or body axes as the dead-reckoning model says (motion.h);
//         what is "in entity" or "in target" is along that entity's body axes.
// Owns:   nothing: RawBytes and VariableParameters lie in the datagram, and are valid as long as its bytes are.
#pragma once

#include "dis/wire.h"
#include "runtime/scene/object_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <variant>

namespace belvedere::dis {

enum PduType : uint8_t {
  kEntityState = 1,
  kFire = 2,
  kDetonation = 3,
  kCollision = 4,
  kCreateEntity = 11,
  kRemoveEntity = 12,
  kStartResume = 13,
  kStopFreeze = 14,
  kElectromagneticEmission = 23,
  kDesignator = 24,
  kTransmitter = 25,
  kSignal = 26,
  kEnvironmentalProcess = 41,
  kGriddedData = 42,
  kEntityStateUpdate = 67,
};

struct PduHeader {
  uint8_t version = 7;
  uint8_t exercise = 1;
  uint8_t type = 0;
  uint8_t family = 1;
  uint32_t timestamp = 0;  // timestamp.h
  uint16_t length = 0;     // of the whole PDU
  uint8_t status = 0;      // version 7 only
};

// 16 bytes that follow an Entity State, its update or a Detonation. Record type 0 is an articulated part, 1 an attached
// one; the others are kept as they came.
struct VariableParameter {
  static constexpr uint8_t kArticulatedPart = 0, kAttachedPart = 1;
  uint8_t record_type = 0;
  uint8_t change = 0;
  uint16_t attached_to = 0;
  uint32_t part_type = 0;  // of an articulated part; the station of an attached one
  float value = 0;         // of an articulated part
  EntityType attached{};   // of an attached part
};

struct VariableParameters {
  static constexpr size_t kBytes = 16;
  RawBytes raw{};
  size_t size() const { return raw.size() / kBytes; }
  VariableParameter operator[](size_t index) const;
};
// The 16 bytes of an articulated or attached part.
std::array<uint8_t, VariableParameters::kBytes> EncodeParameter(const VariableParameter& parameter);

struct EntityState {
  EntityId id{};
  uint8_t force = 0;
  EntityType type{}, alternative_type{};
  glm::vec3 velocity_mps{0.0f};
  glm::dvec3 position_ecef{0.0};
  glm::vec3 orientation_rad{0.0f};  // psi, theta, phi
  uint32_t appearance = 0;
  uint8_t model = 1;  // dead-reckoning model as sent
  std::array<uint8_t, 15> model_parameters{};
  glm::vec3 acceleration_mps2{0.0f};
  glm::vec3 angular_velocity_radps{0.0f};
  uint8_t character_set = 1;
  std::array<uint8_t, 11> marking{};
  uint32_t capabilities = 0;
  VariableParameters parameters{};
};

struct EntityStateUpdate {
  EntityId id{};
  glm::vec3 velocity_mps{0.0f};
  glm::dvec3 position_ecef{0.0};
  glm::vec3 orientation_rad{0.0f};
  uint32_t appearance = 0;
  VariableParameters parameters{};
};

struct MunitionDescriptor {
  EntityType type{};
  uint16_t warhead = 0, fuse = 0, quantity = 0, rate = 0;
};

struct Fire {
  EntityId firing{}, target{}, munition{}, event{};
  uint32_t mission = 0;
  glm::dvec3 position_ecef{0.0};
  MunitionDescriptor descriptor{};
  glm::vec3 velocity_mps{0.0f};
  float range_m = 0;  // 0: not known
};

struct Detonation {
  EntityId firing{}, target{}, munition{}, event{};
  glm::vec3 velocity_mps{0.0f};
  glm::dvec3 position_ecef{0.0};
  MunitionDescriptor descriptor{};
  glm::vec3 position_in_target_m{0.0f};
  uint8_t result = 0;
  VariableParameters parameters{};
};

struct Collision {
  EntityId issuing{}, colliding{}, event{};
  uint8_t type = 0;  // 0 inelastic, 1 elastic
  glm::vec3 velocity_mps{0.0f};
  float mass_kg = 0;
  glm::vec3 position_in_entity_m{0.0f};
};

struct CreateEntity {
  EntityId originating{};
  EntityId created{};
  uint32_t request = 0;
};

struct RemoveEntity {
  EntityId originating{};
  EntityId removed{};  // 0xFFFF in a field stands for all
  uint32_t request = 0;
};

// A moment as simulation management writes it.
struct ClockTime {
  int32_t hours = 0;       // since 1970-01-01 UTC, or since the simulation's own zero
  uint32_t past_hour = 0;  // a timestamp (timestamp.h)
};

struct StartResume {
  EntityId originating{};
  EntityId receiving{};  // 0xFFFF in a field stands for all
  ClockTime real_world{}, simulation{};
  uint32_t request = 0;
};

struct StopFreeze {
  EntityId originating{};
  EntityId receiving{};  // 0xFFFF in a field stands for all
  ClockTime real_world{};
  uint8_t reason = 0;
  uint8_t frozen_behaviour = 0;  // bit 0: clock, 1: transmit, 2: receive
  uint32_t request = 0;
};

struct ElectromagneticEmission {
  EntityId emitting{}, event{};
  uint8_t state_update = 0;  // 0: only what has changed; 1: every system
  uint8_t system_count = 0;
  RawBytes systems{};  // EmitterReader goes through them
};

struct EmitterSystem {
  uint16_t name = 0;
  uint8_t function = 0, number = 0, beam_count = 0;
  glm::vec3 position_in_entity_m{0.0f};
};
struct EmitterBeam {
  uint8_t number = 0;
  uint16_t parameter_index = 0;
  float frequency_hz = 0, frequency_range_hz = 0, effective_power_dbm = 0, pulse_rate_hz = 0, pulse_width_us = 0;
  float azimuth_rad = 0, azimuth_sweep_rad = 0, elevation_rad = 0, elevation_sweep_rad = 0, sweep_sync = 0;
  uint8_t function = 0, high_density = 0, status = 0;
  uint32_t jamming_mode = 0;
  uint8_t target_count = 0;
  RawBytes targets{};  // 8 bytes each
};

// Goes through the systems of an Electromagnetic Emission and the beams of each.
class EmitterReader {
 public:
  explicit EmitterReader(const ElectromagneticEmission& emission)
      : wire_(emission.systems.bytes()), systems_left_(emission.system_count) {}
  // False after the last, and where the bytes end too soon (then fits() is false). Beams not yet read are stepped over.
  bool NextSystem(EmitterSystem& system);
  bool NextBeam(EmitterBeam& beam);
  bool fits() const { return wire_.fits(); }

 private:
  WireReader wire_;
  int systems_left_ = 0, beams_left_ = 0;
};

struct Designator {
  EntityId designating{};
  uint16_t code_name = 0;
  EntityId designated{};
  uint16_t code = 0;
  float power_w = 0, wavelength_um = 0;
  glm::vec3 spot_in_target_m{0.0f};
  glm::dvec3 spot_ecef{0.0};
  uint8_t model = 1;  // dead-reckoning model of the spot
  glm::vec3 acceleration_mps2{0.0f};
};

struct Transmitter {
  EntityId id{};
  uint16_t radio = 0;
  EntityType radio_type{};
  uint8_t state = 0;  // 0 off, 1 on but not transmitting, 2 transmitting
  uint8_t input_source = 0;
  uint16_t variable_count = 0;  // version 7
  glm::dvec3 antenna_ecef{0.0};
  glm::vec3 antenna_in_entity_m{0.0f};
  uint16_t pattern_type = 0;
  uint64_t frequency_hz = 0;
  float bandwidth_hz = 0, power_dbm = 0;
  std::array<uint8_t, 8> modulation{};
  uint16_t crypto_system = 0, crypto_key = 0;
  RawBytes modulation_parameters{}, antenna_pattern{};
};

struct Signal {
  EntityId id{};
  uint16_t radio = 0;
  uint16_t encoding_scheme = 0, tdl_type = 0;
  uint32_t sample_rate_hz = 0;
  uint16_t data_bits = 0, samples = 0;
  RawBytes data{};  // (data_bits + 7) / 8 bytes
};

struct EnvironmentalProcess {
  EntityId id{};
  EntityType type{};
  uint8_t model = 0;
  uint8_t status = 0;  // bit 0: last, bit 1: on
  uint16_t record_count = 0, sequence = 0;
  RawBytes records{};
};

struct GriddedData {
  EntityId id{};
  uint16_t field = 0, pdu_number = 0, pdu_total = 0, coordinate_system = 0;
  uint8_t axis_count = 0, constant_grid = 0;
  EntityType type{};
  glm::vec3 orientation_rad{0.0f};
  uint64_t sample_time = 0;
  uint32_t value_count = 0;
  uint8_t vector_dimension = 0;
  RawBytes grid{};  // axes and values
};

using PduBody = std::variant<std::monostate, EntityState, EntityStateUpdate, Fire, Detonation, Collision, CreateEntity,
                             RemoveEntity, StartResume, StopFreeze, ElectromagneticEmission, Designator, Transmitter,
                             Signal, EnvironmentalProcess, GriddedData>;

}  // namespace belvedere::dis

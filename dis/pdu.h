// The PDUs of DIS that Belvedere reads, as values. IEEE 1278.1-1995 (version 5), 1278.1A-1998 (6) and 1278.1-2012 (7)
// lay them out alike; codec.h reads and writes them.
//
// Units:  as on the wire: metres, seconds, radians.
// Frames: positions ECEF; velocity and acceleration ECEF or body axes as the dead-reckoning model says (motion.h).
#pragma once

#include "runtime/scene/object_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <variant>

namespace belvedere::dis {

enum PduType : uint8_t {
  kEntityState = 1,
  kFire = 2,
  kDetonation = 3,
  kRemoveEntity = 12,
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
  uint8_t record_type = 0;
  uint8_t change = 0;
  uint16_t attached_to = 0;
  uint32_t part_type = 0;  // of an articulated part; the station of an attached one
  float value = 0;         // of an articulated part
  EntityType attached;     // of an attached part
};

// Variable parameters where they lie in the datagram; valid as long as its bytes are.
class VariableParameters {
 public:
  static constexpr size_t kBytes = 16;
  VariableParameters() = default;
  explicit VariableParameters(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  size_t size() const { return bytes_.size() / kBytes; }
  VariableParameter operator[](size_t index) const;

 private:
  std::span<const uint8_t> bytes_;
};

struct EntityState {
  EntityId id;
  uint8_t force = 0;
  EntityType type, alternative_type;
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
  VariableParameters parameters;
};

struct EntityStateUpdate {
  EntityId id;
  glm::vec3 velocity_mps{0.0f};
  glm::dvec3 position_ecef{0.0};
  glm::vec3 orientation_rad{0.0f};
  uint32_t appearance = 0;
  VariableParameters parameters;
};

struct MunitionDescriptor {
  EntityType type;
  uint16_t warhead = 0, fuse = 0, quantity = 0, rate = 0;
};

struct Fire {
  EntityId firing, target, munition, event;
  uint32_t mission = 0;
  glm::dvec3 position_ecef{0.0};
  MunitionDescriptor descriptor;
  glm::vec3 velocity_mps{0.0f};
  float range_m = 0;  // 0: not known
};

struct Detonation {
  EntityId firing, target, munition, event;
  glm::vec3 velocity_mps{0.0f};
  glm::dvec3 position_ecef{0.0};
  MunitionDescriptor descriptor;
  glm::vec3 position_in_target_m{0.0f};
  uint8_t result = 0;
  VariableParameters parameters;
};

struct RemoveEntity {
  EntityId originating;
  EntityId removed;  // 0xFFFF in a field stands for all
  uint32_t request = 0;
};

using PduBody = std::variant<std::monostate, EntityState, EntityStateUpdate, Fire, Detonation, RemoveEntity>;

}  // namespace belvedere::dis

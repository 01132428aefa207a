// What several tests of the room need: an Entity State to start from, and where the shared captures are.
#pragma once

#include "dis/codec.h"

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

namespace belvedere::dis {

inline EntityState SomeEntity(uint16_t entity = 7) {
  EntityState state;
  state.id = {1, 3001, entity};
  state.force = 1;
  state.type = {1, 2, 225, 57, 1, 3, 0};
  state.alternative_type = {1, 2, 225, 57, 1, 3, 1};
  state.velocity_mps = {10.5f, -20.25f, 3.0f};
  state.position_ecef = {-2430000.125, -4440000.5, 3870000.75};
  state.orientation_rad = {0.5f, -0.25f, 3.0f};
  state.appearance = 0x00400018;
  state.model = 4;
  state.acceleration_mps2 = {1.0f, 2.0f, -3.0f};
  state.angular_velocity_radps = {0.01f, 0.02f, 0.03f};
  state.marking = {'U', 'A', 'L', '1', '2', '3'};
  state.capabilities = 0x12345678;
  return state;
}

inline std::vector<uint8_t> Encoded(const EntityState& state, PduHeader header = {}) {
  std::vector<uint8_t> bytes(kEntityStateBytes);
  bytes.resize(EncodePdu(header, state, bytes));
  return bytes;
}

// Every PDU of a datagram. The bytes must stay.
inline std::vector<Pdu> ReadAll(std::span<const uint8_t> datagram) {
  std::vector<Pdu> pdus;
  DatagramReader reader(datagram);
  for (Pdu pdu; reader.Next(pdu);) pdus.push_back(pdu);
  return pdus;
}

// The shared DIS fixtures; empty when they are not there, as in a plain clone.
inline std::filesystem::path SharedDis() {
  const std::filesystem::path path = std::filesystem::path(BELVEDERE_SOURCE_DIR) / ".." / "shared" / "dis";
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace belvedere::dis

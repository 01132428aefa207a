// Intake: datagrams into the object table, with every PDU counted once.
//
//   received = accepted + rejected (by reason) + ignored (by type, or for their version) + filtered (other exercise)
//
// Accepted are the PDUs that were decoded: entity states and their updates are put in the table, Remove Entity takes
// out (0xFFFF stands for any), Fire and Detonation are counted only.
//
// Units:   seconds; arrival on the clock that the table is read with.
// Threads: one at a time; the counters may be copied by their owner only.
#pragma once

#include "dis/codec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace belvedere::dis {

struct IntakeCounters {
  uint64_t datagrams = 0, bytes = 0;
  uint64_t received = 0, accepted = 0, filtered = 0, ignored_version = 0;
  uint64_t unknown_updates = 0;  // of `accepted`: Entity State Updates of entities not known
  std::array<uint64_t, static_cast<size_t>(Rejection::kCount)> rejected{};
  std::array<uint64_t, 256> ignored_type{};
  uint64_t rejected_total() const;
  uint64_t ignored_total() const;  // by type and version
};

// The record that an Entity State describes, as of state_time_s.
ObjectRecord ToRecord(const EntityState& state, double state_time_s, double received_s);

class Intake {
 public:
  Intake(ObjectTable& table, std::optional<uint8_t> exercise) : table_(table), exercise_(exercise) {}
  void Take(std::span<const uint8_t> datagram, double arrival_s, double utc_s);
  const IntakeCounters& counters() const { return counters_; }

 private:
  void Apply(const Pdu& pdu, double arrival_s, double utc_s);
  void Remove(const EntityId& removed);

  ObjectTable& table_;
  const std::optional<uint8_t> exercise_;  // only PDUs of this one
  IntakeCounters counters_;
};

}  // namespace belvedere::dis

// Intake: datagrams into the object table, with every PDU counted once.
//
//   received = accepted + rejected (by reason) + ignored (by type, or for their version) + filtered (other exercise)
//              + refused (by reason; admission.h)
//
// Accepted are the PDUs that were decoded and admitted. Entity states and their updates are put in the table, as of
// when they were true by their sender's clock (sender_clock.h); Remove Entity takes out, Stop/Freeze holds where it is
// and Start/Resume lets go (0xFFFF stands for any); the others are counted only. A datagram of a source that is not
// allowed is not taken apart: it counts in `datagrams` and as one refusal, not in `received`.
//
// Units:   seconds; arrival on the clock that the table is read with.
// Threads: one at a time; the counters may be copied by their owner only.
#pragma once

#include "dis/admission.h"
#include "dis/codec.h"
#include "dis/sender_clock.h"

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
  std::array<uint64_t, static_cast<size_t>(Refusal::kCount)> refused{};
  std::array<uint64_t, 256> ignored_type{};
  uint64_t rejected_total() const;
  uint64_t ignored_total() const;  // by type and version
  uint64_t refused_total() const;  // without whole datagrams
};

struct Arrival {
  double time_s = 0;  // on the table's clock
  double utc_s = 0;   // since 1970-01-01 UTC
  UdpAddress from{};
};

struct IntakeOptions {
  std::optional<uint8_t> exercise{};  // only PDUs of this one; nullopt: all
  AdmissionOptions admission{};
  double scorch_s = 300;  // how long marks of detonations stay on the ground
};

// The record that an Entity State of that version of the protocol describes, as of state_time_s.
ObjectRecord ToRecord(const EntityState& state, uint8_t version, double state_time_s, double received_s);

class Intake {
 public:
  explicit Intake(ObjectTable& table, IntakeOptions options = {})
      : table_(table),
        exercise_(options.exercise),
        scorch_s_(options.scorch_s),
        admission_(std::move(options.admission)) {}
  void Take(std::span<const uint8_t> datagram, const Arrival& arrival);
  const IntakeCounters& counters() const { return counters_; }

 private:
  // Each returns why the PDU was refused, if it was.
  std::optional<Refusal> Apply(const Pdu& pdu, const Arrival& arrival);
  std::optional<Refusal> Apply(const EntityState& state, const PduHeader& header, const Arrival& arrival);
  std::optional<Refusal> Apply(const EntityStateUpdate& update, const PduHeader& header, const Arrival& arrival);
  double StateTime(const EntityId& id, uint32_t timestamp, const Arrival& arrival);
  enum class Command : uint8_t { kRemove, kHold, kRelease };
  std::optional<Refusal> Obey(Command command, const EntityId& named, const Arrival& arrival);

  ObjectTable& table_;
  const std::optional<uint8_t> exercise_;
  const double scorch_s_;
  Admission admission_;
  SenderClocks clocks_;
  IntakeCounters counters_;
};

}  // namespace belvedere::dis

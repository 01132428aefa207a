// Codec: bytes of a datagram to PDUs, and back.
//
// A datagram holds one PDU or a bundle of them, one after the other. DatagramReader goes through it once, checks every
// length before it reads, allocates nothing and never fails as a whole: each PDU gets a verdict. After a PDU whose
// length cannot be trusted the rest of the datagram is given up; after one with bad contents it goes on with the next.
// Fewer bytes than a header, or zeros only, behind the last PDU are padding.
//
// Refused are values that no receiver could use, of the PDUs that the picture is made of: positions, velocities and
// orientations that are not finite (for accelerations and angular velocities: only if the model uses them, otherwise
// they read as 0), positions beyond kFarthestPosition_m, entities numbered 0 ("none") or with 0xFFFF ("all") or 0xFFFE
// in their id.
//
// Threads: pure functions; a reader belongs to its user.
#pragma once

#include "dis/pdu_layout.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace belvedere::dis {

inline constexpr size_t kEntityStateBytes = PduTraits<EntityState>::kFixedBytes;  // without variable parameters
inline constexpr size_t kLongestPdu = 8192;
inline constexpr double kFarthestPosition_m = 1e20;

enum class Rejection : uint8_t {
  kNone,
  kShortHeader,         // fewer bytes than a header
  kLengthUnderHeader,   // the length field is less than a header
  kLengthOverDatagram,  // the length field is more than what is there
  kShortBody,           // the length field is less than this type of PDU takes
  kRecordsDoNotFit,     // more variable parameters, beams, ... than the length has room for
  kNotFinite,
  kPositionOutOfRange,
  kBadEntityId,
  kCount,
};
// "header shorter than 12 bytes" and so on.
std::string_view RejectionText(Rejection rejection);

enum class Verdict : uint8_t {
  kDecoded,
  kIgnoredType,     // a type that Belvedere has no use for; header and length are good
  kIgnoredVersion,  // not version 5, 6 or 7
  kRejected,
};

struct Pdu {
  size_t offset = 0;  // in the datagram
  Verdict verdict = Verdict::kRejected;
  Rejection rejection = Rejection::kNone;
  PduHeader header;  // as far as it was there
  PduBody body;      // monostate unless kDecoded
};

class DatagramReader {
 public:
  // The bytes must stay while the reader and the PDUs it gave are used.
  explicit DatagramReader(std::span<const uint8_t> datagram) : datagram_(datagram) {}
  // False at the end. An empty datagram gives one rejected PDU.
  bool Next(Pdu& pdu);

 private:
  std::span<const uint8_t> datagram_;
  size_t offset_ = 0;
  bool done_ = false;
};

// Writes the PDU and returns its length, or 0 when `out` is too small or the PDU would be longer than its header can
// say. The header's type, family and length are filled in; its version must be 5, 6 or 7. Every body of PduBody but
// monostate can be written.
template <typename Body>
size_t EncodePdu(PduHeader header, const Body& body, std::span<uint8_t> out);

}  // namespace belvedere::dis

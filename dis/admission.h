// Admission: which PDUs a feed takes from whom, so that no sender can flood the picture or take others' entities away.
//
// Everything is admitted unless the options say otherwise. Rates are token buckets of one second, one a host; at
// kMostHosts the host not heard of for longest is forgotten.
//
// Units:   seconds on the user's clock.
// Threads: belongs to its user.
#pragma once

#include "dis/udp_address.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace belvedere::dis {

enum class Refusal : uint8_t {
  kSource,     // the whole datagram: its host is not on the list
  kRate,       // more PDUs a second than a host may send
  kNewEntity,  // more new entities a second than a host may bring
  kStranger,   // Remove, Stop or Start of an entity that another host reports
  kAbsurd,     // at the Earth's centre, deep underground, or beyond the Moon
  kCount,
};
// "source not allowed" and so on.
std::string_view RefusalText(Refusal refusal);

struct AdmissionOptions {
  std::vector<AddressRange> sources{};   // only datagrams from these; empty: from anywhere
  std::vector<AddressRange> managers{};  // who may command entities of others, where strangers may not
  bool refuse_strangers = false;         // Remove, Stop and Start only from who reports the entity, and from managers
  bool refuse_absurd = false;            // places that cannot be shown; otherwise they are kept and flagged
  double pdus_per_s = 0;                 // from one host; 0: any number
  double new_entities_per_s = 0;         // from one host; 0: any number
};

class Admission {
 public:
  static constexpr size_t kMostHosts = 1024;
  explicit Admission(AdmissionOptions options) : options_(std::move(options)) {}
  const AdmissionOptions& options() const { return options_; }

  bool AdmitsSource(const UdpAddress& from) const {
    return options_.sources.empty() || AnyContains(options_.sources, from);
  }
  // Each counts one PDU or entity of the host against its rate.
  bool AdmitsPdu(uint64_t host, double now_s);
  bool AdmitsNewEntity(uint64_t host, double now_s);
  // May `from` command an entity that `owner` reports?
  bool AdmitsCommand(const UdpAddress& from, uint64_t owner) const;

 private:
  struct Bucket {
    double tokens = 0, filled_s = 0;
    bool started = false;
    bool Take(double per_s, double now_s);
  };
  struct Host {
    Bucket pdus, entities;
    double heard_s = 0;
  };
  Host& HostOf(uint64_t host, double now_s);

  const AdmissionOptions options_;
  std::unordered_map<uint64_t, Host> hosts_;
};

}  // namespace belvedere::dis

#include "dis/admission.h"

#include <algorithm>

namespace belvedere::dis {

std::string_view RefusalText(Refusal refusal) {
  constexpr std::array<std::string_view, static_cast<size_t>(Refusal::kCount)> kTexts = {
      "source not allowed",      "host over its rate of PDUs", "host over its rate of new entities",
      "command from a stranger", "place cannot be shown",
  };
  return kTexts[static_cast<size_t>(refusal)];
}

bool Admission::Bucket::Take(double per_s, double now_s) {
  tokens = started ? std::min(tokens + (now_s - filled_s) * per_s, std::max(per_s, 1.0)) : std::max(per_s, 1.0);
  started = true;
  filled_s = now_s;
  if (tokens < 1.0) return false;
  tokens -= 1.0;
  return true;
}

Admission::Host& Admission::HostOf(uint64_t host, double now_s) {
  if (hosts_.size() >= kMostHosts && !hosts_.contains(host)) {
    hosts_.erase(std::min_element(hosts_.begin(), hosts_.end(),
                                  [](const auto& a, const auto& b) { return a.second.heard_s < b.second.heard_s; }));
  }
  Host& known = hosts_[host];
  known.heard_s = now_s;
  return known;
}

bool Admission::AdmitsPdu(uint64_t host, double now_s) {
  return options_.pdus_per_s <= 0 || HostOf(host, now_s).pdus.Take(options_.pdus_per_s, now_s);
}

bool Admission::AdmitsNewEntity(uint64_t host, double now_s) {
  return options_.new_entities_per_s <= 0 || HostOf(host, now_s).entities.Take(options_.new_entities_per_s, now_s);
}

bool Admission::AdmitsCommand(const UdpAddress& from, uint64_t owner) const {
  return !options_.refuse_strangers || from.host() == owner || AnyContains(options_.managers, from);
}

}  // namespace belvedere::dis

// Residuals: how far each report of an entity lies from what its report before, dead-reckoned, says: what receivers of
// that sender see as corrections.
//
// Units:   metres, radians; times from the PDUs' own timestamps, so that the network does not matter.
// Threads: belongs to its user.
#pragma once

#include "dis/pdu.h"

#include <cstdint>
#include <map>
#include <vector>

namespace belvedere::dis {

class Residuals {
 public:
  void Add(const EntityState& state, uint32_t timestamp);
  // One for each report but an entity's first.
  const std::vector<double>& position_m() const { return position_m_; }
  const std::vector<double>& turn_rad() const { return turn_rad_; }
  size_t entities() const { return last_.size(); }

 private:
  struct Last {
    KinematicState state;
    uint32_t timestamp = 0;
  };
  std::map<EntityId, Last> last_;
  std::vector<double> position_m_, turn_rad_;
};

// The value that `share` of them do not exceed; 0 for none. share in [0, 1].
double ValueAt(std::vector<double> values, double share);

}  // namespace belvedere::dis

#include "dis/residuals.h"

#include "dis/intake.h"
#include "dis/timestamp.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere::dis {

void Residuals::Add(const EntityState& state, uint32_t timestamp) {
  const KinematicState now = ToRecord(state, 7, 0.0, 0.0).kinematics;
  const auto [known, is_new] = last_.try_emplace(state.id, Last{now, timestamp});
  if (is_new) return;
  const double dt_s = std::remainder(SecondsPastHour(timestamp) - SecondsPastHour(known->second.timestamp), 3600.0);
  const Pose expected = PoseAt(known->second.state, dt_s);
  const glm::dmat3 turn = glm::transpose(expected.ecef_from_body) * EcefFromBody(now.orientation);
  position_m_.push_back(glm::distance(expected.position_ecef, now.position_ecef));
  turn_rad_.push_back(std::acos(std::clamp(0.5 * (turn[0].x + turn[1].y + turn[2].z - 1.0), -1.0, 1.0)));
  known->second = {now, timestamp};
}

double ValueAt(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(std::max<size_t>(rank, 1), values.size()) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace belvedere::dis

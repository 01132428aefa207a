#include "runtime/app/watched_places.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace belvedere {

void WatchedPlaces::Draw(const glm::dvec3& middle_ecef, const glm::dvec3& rim_ecef, bool finished) {
  const WatchArea area{middle_ecef, std::max(glm::distance(middle_ecef, rim_ecef), kLeastWatched_m)};
  drawn_ = area;
  if (!finished) return;
  drawn_.reset();
  if (areas_.size() >= kMostWatched) areas_.erase(areas_.begin());
  areas_.push_back(area);
}

void WatchedPlaces::Click(const glm::dvec3& point_ecef) {
  if (std::exchange(drawn_, std::nullopt)) return;
  auto smallest = areas_.end();
  for (auto area = areas_.begin(); area != areas_.end(); ++area) {
    if (glm::distance(area->centre_ecef, point_ecef) > area->radius_m) continue;
    if (smallest == areas_.end() || area->radius_m < smallest->radius_m) smallest = area;
  }
  if (smallest != areas_.end()) areas_.erase(smallest);
}

void WatchedPlaces::Clear() {
  areas_.clear();
  drawn_.reset();
}

std::vector<WatchArea> WatchedPlaces::Shown() const {
  std::vector<WatchArea> shown = areas_;
  if (drawn_) shown.push_back(*drawn_);
  return shown;
}

}  // namespace belvedere

// WatchedPlaces: the watch areas of a station: those of its file, and those that its user draws and takes away.
//
// Frames:  ECEF, metres.
// Threads: the UI thread's.
#pragma once

#include "runtime/scene/importance.h"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace belvedere {

inline constexpr size_t kMostWatched = 32;  // beyond that the oldest goes
inline constexpr double kLeastWatched_m = 5.0;

class WatchedPlaces {
 public:
  explicit WatchedPlaces(std::vector<WatchArea> areas) : areas_(std::move(areas)) {}

  // The circle about `middle` through `rim`: shown while it is drawn, kept when it is finished.
  void Draw(const glm::dvec3& middle_ecef, const glm::dvec3& rim_ecef, bool finished);
  // Ends what is being drawn without keeping it; where nothing is, takes away the smallest area that holds the point.
  void Click(const glm::dvec3& point_ecef);
  void Clear();

  const std::vector<WatchArea>& areas() const { return areas_; }
  std::vector<WatchArea> Shown() const;  // with the one that is being drawn

 private:
  std::vector<WatchArea> areas_;
  std::optional<WatchArea> drawn_;
};

}  // namespace belvedere

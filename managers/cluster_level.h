// ClusterLevel: dynamic clustering of moving units, one distance threshold of it. A unit within the threshold of a
// cluster's middle joins the nearest such cluster; the others start new ones; clusters whose middles come too close
// merge (VGIS, Georgia Tech 1998).
//
// It is kept up from update to update, so that clusters are stable while they move: a unit leaves only when it is a
// quarter further from the middle than it may be to join, and clusters merge only at half of that distance.
//
// Frames:  ECEF, metres.
// Threads: belongs to its user.
#pragma once

#include "runtime/scene/cluster_tree.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace belvedere {

struct ClusterUnit {
  uint64_t id = 0;  // of the unit, the same in every update
  ClusterKey key;
  glm::dvec3 position_ecef{0.0};
  uint32_t weight = 1;  // objects in it
};

class ClusterLevel {
 public:
  static constexpr double kLeave = 1.25;  // times the threshold
  static constexpr double kMerge = 0.5;
  explicit ClusterLevel(double join_m) : join_m_(join_m) {}

  // Of every unit the cluster that it is in now, as an index below cluster_count(); valid until the next call. The
  // clusters are numbered in the order of their ids.
  std::span<const uint32_t> Update(std::span<const ClusterUnit> units);
  size_t cluster_count() const { return clusters_.size(); }
  uint64_t id(size_t cluster) const { return clusters_[cluster].id; }

 private:
  struct Live {
    uint64_t id = 0;
    ClusterKey key;
    glm::dvec3 sum{0.0};  // weighted
    double weight = 0;
    uint32_t merged_into = ~uint32_t{0};
    glm::dvec3 centre() const { return sum / weight; }
  };
  class Grid;
  void Keep(std::span<const ClusterUnit> units);
  void Join(std::span<const ClusterUnit> units);
  void Merge();
  void Renumber(std::span<const ClusterUnit> units);

  const double join_m_;
  uint64_t ids_ = 0;
  std::vector<Live> clusters_;
  std::unordered_map<uint64_t, uint64_t> cluster_of_unit_;  // ids
  std::vector<uint32_t> assigned_;
};

}  // namespace belvedere

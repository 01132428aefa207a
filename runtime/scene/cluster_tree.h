// ClusterTree: which objects are together, in several steps from close to far, at one moment. Made by the cluster
// manager, read by the object managers of all views: a view shows a whole cluster as one symbol where its members could
// not be told apart.
//
// Levels count from the finest, 0. Clusters of a level are sorted so that those of one parent lie together, and so do
// the objects of each cluster: of a cluster of any level, the level-0 clusters under it are [first_leaf, end_leaf).
//
// Frames:  ECEF, metres; clock seconds.
// Threads: immutable once published.
#pragma once

#include "runtime/scene/entity.h"
#include "runtime/scene/importance.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace belvedere {

// Clusters are joined up to this distance from their middle; each level reaches four times as far as the one below.
inline constexpr int kClusterLevels = 6;
inline constexpr double kFinestCluster_m = 1'000;
inline constexpr double kClusterGrowth = 4;

// Only objects of the same force, kind and domain are together.
struct ClusterKey {
  uint8_t force = 0, kind = 0, domain = 0;
  bool operator==(const ClusterKey&) const = default;
};

struct Cluster {
  uint64_t id = 0;  // the same for as long as the cluster is there, and never used again
  ClusterKey key;
  glm::dvec3 centre_ecef{0.0};
  glm::dvec3 velocity_mps{0.0};  // mean of its members
  double radius_m = 0;           // of the sphere around the centre that holds its members
  double fastest_mps = 0;        // of its members
  uint32_t members = 0;          // objects
  uint32_t first_leaf = 0, end_leaf = 0;
  uint32_t first_child = 0, end_child = 0;  // in the level below; none at level 0
  float importance = 0;
};

struct ClusterTree {
  double time_s = 0;
  std::vector<std::vector<Cluster>> levels;  // kClusterLevels, or none
  struct Leaf {
    uint32_t incarnation = 0;
    uint32_t cluster = ~uint32_t{0};  // index -> levels[0]
  };
  std::vector<Leaf> leaf_of_slot;  // by ObjectRecord::slot

  static constexpr uint32_t kNone = ~uint32_t{0};
  // The level-0 cluster of an object; kNone for one that came since.
  uint32_t LeafOf(uint32_t slot, uint32_t incarnation) const {
    if (slot >= leaf_of_slot.size() || leaf_of_slot[slot].incarnation != incarnation) return kNone;
    return leaf_of_slot[slot].cluster;
  }
};

}  // namespace belvedere

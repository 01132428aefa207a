// ClusterHierarchy: the levels of clusters over each other, from the objects of a snapshot to a ClusterTree.
//
// Threads: belongs to its user.
#pragma once

#include "managers/cluster_level.h"
#include "runtime/scene/object_table.h"

#include <span>
#include <vector>

namespace belvedere {

class ClusterHierarchy {
 public:
  ClusterHierarchy();
  // Objects that cannot be shown are in no cluster.
  ClusterTree Update(const ObjectSnapshot& snapshot, double now_s, const ImportanceTable& importance,
                     std::span<const WatchArea> watched);

 private:
  std::vector<ClusterLevel> levels_;
};

}  // namespace belvedere

// Group selection: which clusters one view shows as one symbol, and which it need not look into because none of their
// objects can be in the picture.
//
// From the coarsest level down: a cluster that is no larger on the screen than kGroup_px (less for important ones) and
// has kLeastGroup members at least is a group; else its children are asked. What was a group stays one until it is half
// as large again, and what was none becomes one only under the size itself, so that groups do not come and go. Groups
// are made only where a view has more than kFewObjects before it.
//
// Threads: pure; the memory belongs to its user.
#pragma once

#include "runtime/scene/cluster_tree.h"
#include "runtime/scene/view_parameters.h"

#include <cstdint>
#include <unordered_set>
#include <vector>

namespace belvedere {

inline constexpr double kGroup_px = 120;          // across, of a cluster that does not matter
inline constexpr double kImportantGroup_px = 24;  // of one that matters most
inline constexpr uint32_t kLeastGroup = 3;
inline constexpr uint32_t kFewObjects = 250;
inline constexpr uint32_t kMostSymbols = 400;

class GroupSelection {
 public:
  enum class State : uint8_t { kOpen, kHidden, kGrouped };
  void Select(const ClusterTree& tree, const ViewParameters& view, const ViewMatrices& matrices, double now_s);
  // Of a level-0 cluster.
  State StateOf(uint32_t leaf) const { return leaf < leaves_.size() ? leaves_[leaf] : State::kOpen; }
  const std::vector<const Cluster*>& groups() const { return groups_; }

 private:
  struct Scene;
  void Visit(const Scene& scene, size_t level, uint32_t index);
  uint32_t Count(const Scene& scene) const;

  std::vector<State> leaves_;
  std::vector<const Cluster*> groups_;
  std::unordered_set<uint64_t> were_groups_, are_groups_;  // ids, with the level in the low bits
  bool many_ = false;
  double larger_ = 1;     // than the sizes above
  uint32_t symbols_ = 0;  // groups, and objects in clusters that are open
};

}  // namespace belvedere

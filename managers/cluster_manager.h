// ClusterManager: keeps the clusters of all objects up to date, for every view of a station, on a thread of its own:
// twice a second, or less often where that would take more than kMostClusterShare of the time.
//
// Threads: constructed and destroyed by the UI thread; tree() and Watch() from any.
#pragma once

#include "managers/cluster_hierarchy.h"
#include "managers/paced_thread.h"
#include "runtime/base/clock.h"
#include "runtime/scene/latest_value.h"

#include <memory>
#include <vector>

namespace belvedere {

inline constexpr double kMostClusterShare = 0.08;

// Groups, and which of them matter (importance.h).
struct ClusterOptions {
  ImportanceTable importance;
  std::vector<WatchArea> watched;
};

class ClusterManager {
 public:
  // objects and clock must outlive it.
  ClusterManager(const ObjectTable& objects, ClusterOptions options, const Clock& clock);
  // Never null; without levels until there are objects.
  std::shared_ptr<const ClusterTree> tree() const { return tree_.Get(); }
  // Other watch areas from the next tree on. Any thread.
  void Watch(std::vector<WatchArea> areas) { watched_.Publish(std::move(areas)); }

 private:
  void Step();

  const ObjectTable& objects_;
  const ClusterOptions options_;
  const Clock& clock_;
  ClusterHierarchy hierarchy_;
  double next_s_ = 0;
  LatestValue<ClusterTree> tree_;
  LatestValue<std::vector<WatchArea>> watched_;
  PacedThread thread_;  // last: it stops before the members above go
};

}  // namespace belvedere

#include "managers/cluster_manager.h"

#include "runtime/base/trace.h"

#include <algorithm>
#include <utility>

namespace belvedere {
namespace {

constexpr double kTreesPerSecond = 2.0, kLooksPerSecond = 10.0;

}  // namespace

ClusterManager::ClusterManager(const ObjectTable& objects, ClusterOptions options, const Clock& clock)
    : objects_(objects),
      options_(std::move(options)),
      clock_(clock),
      watched_(options_.watched),
      thread_("clusters", kLooksPerSecond, [this] { Step(); }) {}

void ClusterManager::Step() {
  const double now_s = clock_.NowSeconds();
  if (now_s < next_s_) return;
  const std::shared_ptr<const ObjectSnapshot> snapshot = objects_.Snapshot();
  if (snapshot->objects.empty() && tree_.Get()->levels.empty()) return;
  const TraceSpan span("clusters.tree");
  tree_.Publish(snapshot->objects.empty() ? ClusterTree{}
                                          : hierarchy_.Update(*snapshot, now_s, options_.importance, *watched_.Get()));
  next_s_ = now_s + std::max(1.0 / kTreesPerSecond, (clock_.NowSeconds() - now_s) / kMostClusterShare);
}

}  // namespace belvedere

#include "managers/group_selection.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

constexpr double kStays = 1.5;  // a group may grow so much before it opens
constexpr double kLargerStep = 1.25, kSmallerStep = 1.02, kLargest = 6;
constexpr double kBesidePicture = 0.15;  // of the distance: what may move in

}  // namespace

struct GroupSelection::Scene {
  const ClusterTree& tree;
  const ViewParameters& view;
  const ViewMatrices& matrices;
  double since_s;

  bool Hides(const Cluster& cluster) const {
    const double reach_m = cluster.radius_m + std::abs(since_s) * cluster.fastest_mps + 250.0;
    if (matrices.horizon.Hides({cluster.centre_ecef, reach_m})) return true;
    const double distance_m = glm::distance(cluster.centre_ecef, matrices.eye_ecef);
    return matrices.frustum.Hides({cluster.centre_ecef, reach_m + kBesidePicture * distance_m});
  }
  double SizeOnScreen(const Cluster& cluster) const {
    const double distance_m = std::max(glm::distance(cluster.centre_ecef, matrices.eye_ecef), 1.0);
    const double metre_px = view.projection == Projection::kPerspective ? matrices.pixels_per_radian / distance_m
                                                                        : matrices.pixels_per_metre;
    return 2.0 * cluster.radius_m * metre_px;
  }
};

// Objects in clusters that may be seen, as far as it matters.
uint32_t GroupSelection::Count(const Scene& scene) const {
  uint32_t count = 0;
  for (const Cluster& cluster : scene.tree.levels.back()) {
    if (!scene.Hides(cluster)) count += cluster.members;
  }
  return count;
}

void GroupSelection::Select(const ClusterTree& tree, const ViewParameters& view, const ViewMatrices& matrices,
                            double now_s) {
  groups_.clear();
  leaves_.clear();
  if (tree.levels.empty()) return;
  const Scene scene{tree, view, matrices, now_s - tree.time_s};
  leaves_.assign(tree.levels[0].size(), State::kOpen);
  const uint32_t before = Count(scene);
  many_ = before > (many_ ? kFewObjects * 4 / 5 : kFewObjects);
  constexpr int kTries = 8;
  for (int i = 0; i < kTries; ++i) {
    groups_.clear();
    are_groups_.clear();
    symbols_ = 0;
    for (uint32_t top = 0; top < tree.levels.back().size(); ++top) Visit(scene, tree.levels.size() - 1, top);
    if (!many_ || symbols_ <= kMostSymbols || larger_ >= kLargest) break;
    larger_ = std::min(larger_ * kLargerStep, kLargest);
  }
  if (symbols_ < kMostSymbols / 3) larger_ = std::max(1.0, larger_ / kSmallerStep);
  were_groups_.swap(are_groups_);
}

void GroupSelection::Visit(const Scene& scene, size_t level, uint32_t index) {
  const Cluster& cluster = scene.tree.levels[level][index];
  const auto mark = [&](State state) {
    std::fill(leaves_.begin() + cluster.first_leaf, leaves_.begin() + cluster.end_leaf, state);
  };
  if (scene.Hides(cluster)) return mark(State::kHidden);
  const uint64_t id = cluster.id << 3 | level;
  if (many_ && cluster.members >= kLeastGroup) {
    const double importance = static_cast<double>(cluster.importance);
    const double limit_px = larger_ * (kGroup_px + importance * (kImportantGroup_px - kGroup_px));
    const double stays = were_groups_.contains(id) ? kStays : 1.0;
    if (scene.SizeOnScreen(cluster) <= stays * limit_px) {
      groups_.push_back(&cluster);
      are_groups_.insert(id);
      ++symbols_;
      return mark(State::kGrouped);
    }
  }
  if (level == 0) symbols_ += cluster.members;
  for (uint32_t child = cluster.first_child; level > 0 && child < cluster.end_child; ++child)
    Visit(scene, level - 1, child);
}

}  // namespace belvedere

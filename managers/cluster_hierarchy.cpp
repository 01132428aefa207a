#include "managers/cluster_hierarchy.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace belvedere {
namespace {

// What members add to their cluster, and clusters to their parents.
struct Sums {
  glm::dvec3 position{0.0}, velocity{0.0};
  double members = 0, damage = 0;
};

struct Level {
  std::vector<uint32_t> parent_of;  // of each unit of the level below
  std::vector<uint64_t> ids;
  std::vector<ClusterKey> keys;
  std::vector<Sums> sums;
};

glm::dvec3 RoughVelocity(const KinematicState& state) {
  if (state.model == DeadReckoning::kStatic) return glm::dvec3(0.0);
  return ModelUsesBodyAxes(state.model) ? EcefFromBody(state.orientation) * state.velocity_mps : state.velocity_mps;
}

double DistanceOf(const glm::dvec3& position, std::span<const WatchArea> watched) {
  double least_m = 1e9;
  for (const WatchArea& area : watched) {
    least_m = std::min(least_m, std::max(glm::distance(position, area.centre_ecef) - area.radius_m, 0.0));
  }
  return least_m;
}

float ImportanceOf(const Cluster& cluster, const Sums& sums, const ImportanceTable& table,
                   std::span<const WatchArea> watched) {
  ImportanceFacts facts{};
  const auto set = [&](ImportanceInput input, double value) { facts[static_cast<size_t>(input)] = value; };
  const ClusterKey& key = cluster.key;
  const auto domain = [&](uint8_t wanted) {
    return key.kind == EntityType::kPlatform && key.domain == wanted ? 1.0 : 0.0;
  };
  set(ImportanceInput::kSpeed, glm::length(cluster.velocity_mps));
  set(ImportanceInput::kDistance, DistanceOf(cluster.centre_ecef, watched));
  set(ImportanceInput::kNumber, sums.members);
  set(ImportanceInput::kDamage, sums.damage / sums.members);
  set(ImportanceInput::kFriendly, key.force == 1 ? 1 : 0);
  set(ImportanceInput::kOpposing, key.force == 2 ? 1 : 0);
  set(ImportanceInput::kNeutral, key.force == 3 ? 1 : 0);
  set(ImportanceInput::kAir, domain(EntityType::kAir));
  set(ImportanceInput::kLand, domain(EntityType::kLand));
  set(ImportanceInput::kSea, domain(EntityType::kSurface));
  set(ImportanceInput::kMunition, key.kind == EntityType::kMunition ? 1 : 0);
  return static_cast<float>(table.Of(facts));
}

}  // namespace

ClusterHierarchy::ClusterHierarchy() {
  double join_m = kFinestCluster_m;
  for (int level = 0; level < kClusterLevels; ++level, join_m *= kClusterGrowth) levels_.emplace_back(join_m);
}

ClusterTree ClusterHierarchy::Update(const ObjectSnapshot& snapshot, double now_s, const ImportanceTable& importance,
                                     std::span<const WatchArea> watched) {
  std::vector<ClusterUnit> units;
  std::vector<const ObjectRecord*> records;
  std::vector<Sums> below;
  for (const ObjectRecord& record : snapshot.objects) {
    if (!record.visible()) continue;
    const glm::dvec3 velocity = RoughVelocity(record.kinematics);
    const glm::dvec3 position = record.kinematics.position_ecef + (now_s - record.kinematics.time_s) * velocity;
    const uint64_t id = uint64_t{record.incarnation} << 32 | record.slot;
    units.push_back({id, {record.force, record.type.kind, record.type.domain}, position, 1});
    records.push_back(&record);
    below.push_back({position, velocity, 1, record.damage() / 3.0});
  }
  const std::vector<Sums> objects = below;

  std::vector<Level> levels(kClusterLevels);
  for (size_t l = 0; l < levels.size(); ++l) {
    Level& level = levels[l];
    const std::span<const uint32_t> assigned = levels_[l].Update(units);
    level.parent_of.assign(assigned.begin(), assigned.end());
    const size_t count = levels_[l].cluster_count();
    level.sums.resize(count);
    level.keys.resize(count);
    level.ids.resize(count);
    for (size_t i = 0; i < units.size(); ++i) {
      Sums& sums = level.sums[assigned[i]];
      sums.position += below[i].position;
      sums.velocity += below[i].velocity;
      sums.members += below[i].members;
      sums.damage += below[i].damage;
      level.keys[assigned[i]] = units[i].key;
    }
    units.clear();
    for (size_t i = 0; i < count; ++i) {
      level.ids[i] = levels_[l].id(i);
      const Sums& sums = level.sums[i];
      units.push_back({level.ids[i], level.keys[i], sums.position / sums.members, static_cast<uint32_t>(sums.members)});
    }
    below = level.sums;
  }

  // Number the clusters of each level so that those of one parent lie together, from the top.
  ClusterTree tree;
  tree.time_s = now_s;
  tree.levels.resize(kClusterLevels);
  std::vector<uint32_t> place(levels.back().ids.size());  // of each cluster of the level above, in the tree
  std::iota(place.begin(), place.end(), 0u);
  for (size_t l = levels.size(); l-- > 0;) {
    const Level& level = levels[l];
    std::vector<uint32_t> order(level.ids.size());
    std::iota(order.begin(), order.end(), 0u);
    if (l + 1 < levels.size()) {
      const std::vector<uint32_t>& parent_of = levels[l + 1].parent_of;
      std::stable_sort(order.begin(), order.end(),
                       [&](uint32_t a, uint32_t b) { return place[parent_of[a]] < place[parent_of[b]]; });
    }
    std::vector<uint32_t> places(order.size());
    tree.levels[l].resize(order.size());
    for (uint32_t at = 0; at < order.size(); ++at) {
      const uint32_t cluster = order[at];
      places[cluster] = at;
      const Sums& sums = level.sums[cluster];
      Cluster& made = tree.levels[l][at];
      made.id = level.ids[cluster];
      made.key = level.keys[cluster];
      made.centre_ecef = sums.position / sums.members;
      made.velocity_mps = sums.velocity / sums.members;
      made.members = static_cast<uint32_t>(sums.members);
      made.importance = ImportanceOf(made, sums, importance, watched);
      if (l + 1 < levels.size()) {
        Cluster& parent = tree.levels[l + 1][place[levels[l + 1].parent_of[cluster]]];
        if (parent.end_child == parent.first_child) parent.first_child = parent.end_child = at;
        parent.end_child = at + 1;
      }
    }
    place.swap(places);
  }
  // `place` is that of level 0 now.
  for (size_t i = 0; i < records.size(); ++i) {
    const ObjectRecord& record = *records[i];
    if (record.slot >= tree.leaf_of_slot.size()) tree.leaf_of_slot.resize(size_t{record.slot} + 1);
    const uint32_t leaf = place[levels[0].parent_of[i]];
    tree.leaf_of_slot[record.slot] = {record.incarnation, leaf};
    Cluster& cluster = tree.levels[0][leaf];
    cluster.radius_m = std::max(cluster.radius_m, glm::distance(cluster.centre_ecef, objects[i].position));
    cluster.fastest_mps = std::max(cluster.fastest_mps, glm::length(objects[i].velocity));
  }
  for (uint32_t leaf = 0; leaf < tree.levels[0].size(); ++leaf) {
    tree.levels[0][leaf].first_leaf = leaf;
    tree.levels[0][leaf].end_leaf = leaf + 1;
  }
  for (size_t l = 1; l < tree.levels.size(); ++l) {
    for (Cluster& cluster : tree.levels[l]) {
      cluster.first_leaf = tree.levels[l - 1][cluster.first_child].first_leaf;
      cluster.end_leaf = tree.levels[l - 1][cluster.end_child - 1].end_leaf;
      for (uint32_t child = cluster.first_child; child < cluster.end_child; ++child) {
        const Cluster& one = tree.levels[l - 1][child];
        cluster.radius_m =
            std::max(cluster.radius_m, glm::distance(cluster.centre_ecef, one.centre_ecef) + one.radius_m);
        cluster.fastest_mps = std::max(cluster.fastest_mps, one.fastest_mps);
      }
    }
  }
  return tree;
}

}  // namespace belvedere

#include "managers/cluster_level.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr uint32_t kNone = ~uint32_t{0};

}  // namespace

// Clusters by the cube of one threshold's side that their middle lies in: who is within it lies in 27 cubes.
class ClusterLevel::Grid {
 public:
  Grid(const std::vector<Live>& clusters, double side_m) : clusters_(clusters), side_m_(side_m) {}
  void Add(uint32_t cluster, const glm::dvec3& centre) { cells_[CellOf(centre, 0, 0, 0)].push_back({cluster, centre}); }
  // The nearest with that key within `reach_m`, kNone where there is none.
  uint32_t Nearest(const glm::dvec3& at, const ClusterKey& key, double reach_m, uint32_t but = kNone) const {
    uint32_t nearest = kNone;
    double least = reach_m * reach_m;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto cell = cells_.find(CellOf(at, dx, dy, dz));
          if (cell == cells_.end()) continue;
          for (const auto& [cluster, centre] : cell->second) {
            const glm::dvec3 off = centre - at;
            const double square = glm::dot(off, off);
            if (square > least || cluster == but || !(clusters_[cluster].key == key) ||
                clusters_[cluster].merged_into != kNone) {
              continue;
            }
            least = square;
            nearest = cluster;
          }
        }
      }
    }
    return nearest;
  }

 private:
  uint64_t CellOf(const glm::dvec3& at, int dx, int dy, int dz) const {
    const auto cell = [&](double x, int d) {
      return static_cast<uint64_t>(static_cast<int64_t>(std::floor(x / side_m_)) + d) & 0x1FFFFF;
    };
    return cell(at.x, dx) << 42 | cell(at.y, dy) << 21 | cell(at.z, dz);
  }
  const std::vector<Live>& clusters_;
  const double side_m_;
  std::unordered_map<uint64_t, std::vector<std::pair<uint32_t, glm::dvec3>>> cells_;
};

std::span<const uint32_t> ClusterLevel::Update(std::span<const ClusterUnit> units) {
  assigned_.assign(units.size(), kNone);
  Keep(units);
  Join(units);
  Merge();
  Renumber(units);
  return assigned_;
}

// Units stay in their cluster while they are near its middle; where that is follows from those that stay.
void ClusterLevel::Keep(std::span<const ClusterUnit> units) {
  std::unordered_map<uint64_t, uint32_t> index_of;
  index_of.reserve(clusters_.size());
  for (uint32_t i = 0; i < clusters_.size(); ++i) {
    index_of.emplace(clusters_[i].id, i);
    clusters_[i].sum = glm::dvec3(0.0);
    clusters_[i].weight = 0;
  }
  for (size_t i = 0; i < units.size(); ++i) {
    const auto known = cluster_of_unit_.find(units[i].id);
    if (known == cluster_of_unit_.end()) continue;
    const auto index = index_of.find(known->second);
    if (index == index_of.end() || !(clusters_[index->second].key == units[i].key)) continue;
    assigned_[i] = index->second;
    clusters_[index->second].sum += static_cast<double>(units[i].weight) * units[i].position_ecef;
    clusters_[index->second].weight += units[i].weight;
  }
  const double leave_m = kLeave * join_m_;
  for (size_t i = 0; i < units.size(); ++i) {
    if (assigned_[i] == kNone) continue;
    Live& cluster = clusters_[assigned_[i]];
    const glm::dvec3 off = units[i].position_ecef - cluster.centre();
    if (glm::dot(off, off) <= leave_m * leave_m) continue;
    const bool alone = cluster.weight <= units[i].weight;
    if (alone) continue;
    cluster.sum -= static_cast<double>(units[i].weight) * units[i].position_ecef;
    cluster.weight -= units[i].weight;
    assigned_[i] = kNone;
  }
}

void ClusterLevel::Join(std::span<const ClusterUnit> units) {
  Grid grid(clusters_, join_m_);
  for (uint32_t i = 0; i < clusters_.size(); ++i) {
    if (clusters_[i].weight > 0) grid.Add(i, clusters_[i].centre());
  }
  for (size_t i = 0; i < units.size(); ++i) {
    if (assigned_[i] != kNone) continue;
    const ClusterUnit& unit = units[i];
    uint32_t cluster = grid.Nearest(unit.position_ecef, unit.key, join_m_);
    if (cluster == kNone) {
      cluster = static_cast<uint32_t>(clusters_.size());
      clusters_.push_back({.id = ++ids_, .key = unit.key});
      grid.Add(cluster, unit.position_ecef);
    }
    assigned_[i] = cluster;
    clusters_[cluster].sum += static_cast<double>(unit.weight) * unit.position_ecef;
    clusters_[cluster].weight += unit.weight;
  }
}

// The lighter of two that are too close goes into the heavier.
void ClusterLevel::Merge() {
  Grid grid(clusters_, join_m_);
  for (uint32_t i = 0; i < clusters_.size(); ++i) {
    if (clusters_[i].weight > 0) grid.Add(i, clusters_[i].centre());
  }
  for (uint32_t i = 0; i < clusters_.size(); ++i) {
    Live& cluster = clusters_[i];
    if (cluster.weight <= 0 || cluster.merged_into != kNone) continue;
    const uint32_t other = grid.Nearest(cluster.centre(), cluster.key, kMerge * join_m_, i);
    if (other == kNone) continue;
    const bool into_other =
        clusters_[other].weight > cluster.weight || (clusters_[other].weight == cluster.weight && other < i);
    Live &from = into_other ? cluster : clusters_[other], &into = into_other ? clusters_[other] : cluster;
    into.sum += from.sum;
    into.weight += from.weight;
    from.merged_into = into_other ? other : i;
    from.weight = 0;
  }
}

void ClusterLevel::Renumber(std::span<const ClusterUnit> units) {
  std::vector<uint32_t> number(clusters_.size(), kNone);
  std::vector<Live> left;
  left.reserve(clusters_.size());
  for (uint32_t i = 0; i < clusters_.size(); ++i) {
    if (clusters_[i].weight <= 0) continue;
    number[i] = static_cast<uint32_t>(left.size());
    left.push_back(clusters_[i]);
  }
  cluster_of_unit_.clear();
  cluster_of_unit_.reserve(units.size());
  for (size_t i = 0; i < units.size(); ++i) {
    uint32_t cluster = assigned_[i];
    while (clusters_[cluster].merged_into != kNone) cluster = clusters_[cluster].merged_into;
    assigned_[i] = number[cluster];
    cluster_of_unit_.emplace(units[i].id, clusters_[cluster].id);
  }
  clusters_.swap(left);
}

}  // namespace belvedere

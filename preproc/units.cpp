#include "preproc/units.h"

#include <algorithm>
#include <numeric>

namespace belvedere {
namespace {

void AddUnits(int layer, std::span<const PlannedSource> plan, Quadcode node, std::vector<Unit>& units) {
  const int64_t pages = CountNodesUnder(plan, node);
  if (pages <= kMostPagesOfUnit) {
    units.push_back({layer, node, pages});
    return;
  }
  for (const int which : node.Children()) AddUnits(layer, plan, node.Child(which), units);
}

}  // namespace

std::vector<Unit> UnitsOf(int layer, std::span<const PlannedSource> plan) {
  std::vector<Unit> units;
  for (int tree = 0; tree < kTrees; ++tree) AddUnits(layer, plan, Quadcode::Root(tree), units);
  return units;
}

std::vector<int> ShardsOf(std::span<const Unit> units, int shards) {
  std::vector<size_t> order(units.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return units[a].pages > units[b].pages; });
  std::vector<int64_t> load(static_cast<size_t>(shards), 0);
  std::vector<int> shard_of(units.size(), 0);
  for (const size_t unit : order) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += units[unit].pages;
    shard_of[unit] = static_cast<int>(least - load.begin());
  }
  return shard_of;
}

}  // namespace belvedere

#include "preproc/plan.h"

#include "runtime/paging/page.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

// Pixels that are a hair closer than posts do not ask for another level.
constexpr double kSpacingSlack = 1.001;

}  // namespace

std::vector<size_t> PlacesByResolution(std::span<const PlannedSource> sources) {
  constexpr double kThousandths = 1000;
  std::vector<size_t> places(sources.size());
  std::iota(places.begin(), places.end(), size_t{0});
  const auto fineness = [&](size_t place) {
    const PlannedSource& source = sources[place];
    return std::pair{source.timed, -std::lround(kThousandths * std::log(source.spacing_deg))};
  };
  std::stable_sort(places.begin(), places.end(), [&](size_t a, size_t b) { return fineness(a) < fineness(b); });
  return places;
}

int FinestLevel(double spacing_deg, LayerKind kind) {
  double spacing = kTreeDegrees / (kind == LayerKind::kElevation ? kCells : kImageInner);
  int level = 0;
  while (level < kMaxLevel && spacing > spacing_deg * kSpacingSlack) {
    spacing /= 2;
    ++level;
  }
  return level;
}

int SourceLevel(std::span<const PlannedSource> sources, Quadcode node) {
  int level = 0;
  const GeoBox box = node.Box();
  for (const PlannedSource& source : sources) {
    if (source.finest_level > level && Overlap(source.extent, box)) level = source.finest_level;
  }
  return level;
}

int64_t CountNodesUnder(std::span<const PlannedSource> sources, Quadcode node) {
  std::vector<PlannedSource> here;
  const GeoBox box = node.Box();
  std::copy_if(sources.begin(), sources.end(), std::back_inserter(here), [&](const PlannedSource& source) {
    return source.finest_level > node.level() && Overlap(source.extent, box);
  });
  int64_t count = 1;
  if (here.empty()) return count;
  for (const int which : node.Children()) count += CountNodesUnder(here, node.Child(which));
  return count;
}

int64_t CountNodes(std::span<const PlannedSource> sources) {
  int64_t count = 0;
  for (int tree = 0; tree < kTrees; ++tree) count += CountNodesUnder(sources, Quadcode::Root(tree));
  return count;
}

}  // namespace belvedere

#include "managers/reach.h"

#include <algorithm>

namespace belvedere {
namespace {

struct Extent {
  uint32_t west, south, width, height;
  explicit Extent(Quadcode node)
      : west(node.SouthWest().x), south(node.SouthWest().y), width(node.GridWidth()), height(node.GridHeight()) {}
  uint32_t north() const { return south + height; }
};

bool Touch(const Extent& a, const Extent& b) {
  if (a.south > b.north() || b.south > a.north()) return false;
  if (a.south == 0 && b.south == 0) return true;
  if (a.north() == kGridNorthPole && b.north() == kGridNorthPole) return true;
  // Unsigned: longitudes wrap.
  return b.west - a.west <= a.width || a.west - b.west <= b.width;
}

// Adds those of `others` that touch one of `of`.
void AddTouching(const std::vector<Extent>& extents, const std::vector<Extent>& of, std::vector<bool>& touching) {
  for (size_t i = 0; i < extents.size(); ++i) {
    if (touching[i]) continue;
    touching[i] = std::any_of(of.begin(), of.end(), [&](const Extent& other) { return Touch(extents[i], other); });
  }
}

std::vector<Extent> Chosen(const std::vector<Extent>& extents, const std::vector<bool>& which) {
  std::vector<Extent> chosen;
  for (size_t i = 0; i < extents.size(); ++i) {
    if (which[i]) chosen.push_back(extents[i]);
  }
  return chosen;
}

}  // namespace

bool Touch(Quadcode a, Quadcode b) {
  return Touch(Extent(a), Extent(b));
}

Reach ReachOf(std::span<const Quadcode> nodes, const std::vector<bool>& is_new, std::span<const Quadcode> gone) {
  const std::vector<Extent> extents(nodes.begin(), nodes.end());
  std::vector<Extent> changed = Chosen(extents, is_new);
  for (const Quadcode node : gone) changed.emplace_back(node);
  Reach reach{is_new, {}};
  AddTouching(extents, changed, reach.joined);
  reach.asked = reach.joined;
  AddTouching(extents, Chosen(extents, reach.joined), reach.asked);
  return reach;
}

}  // namespace belvedere

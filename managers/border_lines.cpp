#include "managers/border_lines.h"

#include <algorithm>
#include <tuple>

namespace belvedere {
namespace {

constexpr uint64_t kAroundTheEarth = uint64_t{1} << 32;

bool IsMeridian(Border border) {
  return border == Border::kWest || border == Border::kEast;
}

}  // namespace

void BorderLines::Clear() {
  vertices_.clear();
}

uint64_t BorderLines::LineOf(Quadcode node, Border border) {
  const GridPoint corner = node.SouthWest();
  switch (border) {
    case Border::kWest: return corner.x;
    case Border::kEast: return static_cast<uint32_t>(corner.x + node.GridWidth());  // wraps at 180 E
    case Border::kSouth: return kParallel | corner.y;
    case Border::kNorth: return kParallel | (corner.y + node.GridHeight());
  }
  return 0;
}

uint32_t BorderLines::SpacingAlong(Quadcode node, Border border) {
  return IsMeridian(border) ? node.PostSpacingNorth() : node.PostSpacingEast();
}

uint64_t BorderLines::PositionOf(Quadcode node, Border border, int post) {
  const GridPoint corner = node.SouthWest();
  const uint64_t start = IsMeridian(border) ? corner.y : corner.x;
  return start + static_cast<uint64_t>(post) * SpacingAlong(node, border);
}

void BorderLines::Add(Quadcode node, Border border, int post, uint32_t corner, uint32_t rank) {
  const uint64_t line = LineOf(node, border);
  const uint64_t position = PositionOf(node, border, post);
  vertices_.push_back({line, position, corner, rank});
  if (IsMeridian(border)) return;
  // 180 W and 180 E are one place at both ends of every parallel.
  if (position == 0) vertices_.push_back({line, kAroundTheEarth, corner, rank});
  if (position == kAroundTheEarth) vertices_.push_back({line, 0, corner, rank});
}

void BorderLines::Seal() {
  std::sort(vertices_.begin(), vertices_.end(), [](const BorderVertex& a, const BorderVertex& b) {
    return std::tie(a.line, a.position, a.rank, a.corner) < std::tie(b.line, b.position, b.rank, b.corner);
  });
  const auto last = std::unique(vertices_.begin(), vertices_.end(), [](const BorderVertex& a, const BorderVertex& b) {
    return a.line == b.line && a.position == b.position;
  });
  vertices_.erase(last, vertices_.end());
}

std::span<const BorderVertex> BorderLines::Along(Quadcode node, Border border) const {
  const uint64_t line = LineOf(node, border);
  const auto before = [](const BorderVertex& a, const std::pair<uint64_t, uint64_t>& b) {
    return std::tie(a.line, a.position) < std::tie(b.first, b.second);
  };
  const auto begin =
      std::lower_bound(vertices_.begin(), vertices_.end(), std::pair{line, PositionOf(node, border, 0)}, before);
  const auto end =
      std::lower_bound(begin, vertices_.end(), std::pair{line, PositionOf(node, border, kCells) + 1}, before);
  return {begin, end};
}

}  // namespace belvedere

#include "preproc/vectors/clip.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace belvedere {
namespace {

struct Cut {
  GridAxis axis;
  int64_t at;

  int64_t Along(const GridPlace& place) const { return axis == GridAxis::kX ? place.x : place.y; }
  // -1 below, 0 on the line, 1 above.
  int SideOf(const GridPlace& place) const { return (Along(place) > at) - (Along(place) < at); }
  // The same whichever way the line runs.
  GridPlace Crossing(GridPlace a, GridPlace b) const {
    if (b < a) std::swap(a, b);
    const double share = static_cast<double>(at - Along(a)) / static_cast<double>(Along(b) - Along(a));
    const auto between = [share](int64_t from, int64_t to) {
      return from + std::llround(share * static_cast<double>(to - from));
    };
    return axis == GridAxis::kX ? GridPlace{at, between(a.y, b.y)} : GridPlace{between(a.x, b.x), at};
  }
};

void Append(FeaturePart& part, const GridPlace& place) {
  if (part.empty() || part.back() != place) part.push_back(place);
}

// Goes on with the last part where the segment starts at its end.
void AddSegment(FeatureParts& parts, const GridPlace& a, const GridPlace& b) {
  if (a == b) return;
  if (parts.empty() || parts.back().back() != a) parts.push_back({a});
  parts.back().push_back(b);
}

void CutLine(const FeaturePart& line, const Cut& cut, std::array<FeatureParts, 2>& out) {
  for (size_t i = 1; i < line.size(); ++i) {
    const GridPlace &a = line[i - 1], &b = line[i];
    const int from = cut.SideOf(a), to = cut.SideOf(b);
    if (from * to < 0) {
      const GridPlace crossing = cut.Crossing(a, b);
      AddSegment(out[from > 0], a, crossing);
      AddSegment(out[to > 0], crossing, b);
    } else {
      AddSegment(out[from + to >= 0], a, b);
    }
  }
}

// Nothing where the side has no area.
void CutRing(const FeaturePart& ring, const Cut& cut, int side, FeatureParts& out) {
  FeaturePart kept;
  bool is_inside = false;
  for (size_t i = 0; i < ring.size(); ++i) {
    const GridPlace &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const int from = cut.SideOf(a), to = cut.SideOf(b);
    if (from * side >= 0) Append(kept, a);
    if (from * to < 0) Append(kept, cut.Crossing(a, b));
    is_inside |= from * side > 0;
  }
  while (kept.size() > 1 && kept.back() == kept.front()) kept.pop_back();
  if (is_inside && kept.size() >= 3) out.push_back(std::move(kept));
}

}  // namespace

std::array<FeatureParts, 2> CutInTwo(const FeatureParts& parts, FeatureShape shape, GridAxis axis, int64_t at) {
  const Cut cut{axis, at};
  std::array<FeatureParts, 2> out;
  for (const FeaturePart& part : parts) {
    const bool is_below =
        std::all_of(part.begin(), part.end(), [&](const GridPlace& place) { return cut.SideOf(place) < 0; });
    const bool is_above =
        std::all_of(part.begin(), part.end(), [&](const GridPlace& place) { return cut.SideOf(place) >= 0; });
    if (is_below || is_above) {
      out[is_above].push_back(part);
    } else if (shape == FeatureShape::kLines) {
      CutLine(part, cut, out);
    } else if (shape == FeatureShape::kPolygons) {
      CutRing(part, cut, -1, out[0]);
      CutRing(part, cut, 1, out[1]);
    } else {
      std::array<FeaturePart, 2> sides;
      for (const GridPlace& place : part) sides[cut.SideOf(place) >= 0].push_back(place);
      for (size_t side = 0; side < 2; ++side) out[side].push_back(std::move(sides[side]));
    }
  }
  return out;
}

}  // namespace belvedere

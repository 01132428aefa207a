#include "preproc/vectors/simplify.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

double Distance(const GridPlace& place, const GridPlace& a, const GridPlace& b) {
  const auto x = static_cast<double>(place.x - a.x), y = static_cast<double>(place.y - a.y);
  const auto along_x = static_cast<double>(b.x - a.x), along_y = static_cast<double>(b.y - a.y);
  const double squared = along_x * along_x + along_y * along_y;
  const double t = squared > 0 ? std::clamp((x * along_x + y * along_y) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(x - t * along_x, y - t * along_y);
}

// Marks what is needed between two points that stay; the furthest that is not.
double Mark(const FeaturePart& part, size_t from, size_t to, double tolerance, std::vector<bool>& stays) {
  double deviation = 0;
  std::vector<std::pair<size_t, size_t>> stretches{{from, to}};
  while (!stretches.empty()) {
    const auto [first, last] = stretches.back();
    stretches.pop_back();
    double furthest = 0;
    size_t at = first;
    for (size_t i = first + 1; i < last; ++i) {
      const double distance = Distance(part[i], part[first], part[last]);
      if (distance <= furthest) continue;
      furthest = distance;
      at = i;
    }
    if (furthest <= tolerance) {
      deviation = std::max(deviation, furthest);
      continue;
    }
    stays[at] = true;
    stretches.emplace_back(first, at);
    stretches.emplace_back(at, last);
  }
  return deviation;
}

}  // namespace

Simplified Simplify(const FeaturePart& part, FeatureShape shape, double tolerance,
                    const std::function<bool(const GridPlace&)>& is_kept) {
  if (shape == FeatureShape::kPoints || tolerance <= 0) return {part, 0};
  FeaturePart open = part;
  const bool is_ring = shape == FeatureShape::kPolygons;
  if (is_ring) open.push_back(part.front());
  std::vector<bool> stays(open.size());
  stays.front() = stays.back() = true;
  for (size_t i = 0; i < open.size(); ++i) {
    if (is_kept(open[i])) stays[i] = true;
  }
  // A ring needs a second point to be measured from: the one that is furthest from the first.
  const bool has_one = is_ring && std::count(stays.begin(), stays.end(), true) == 2;
  if (has_one) {
    const auto far = std::max_element(open.begin(), open.end(), [&](const GridPlace& a, const GridPlace& b) {
      return Distance(a, open.front(), open.front()) < Distance(b, open.front(), open.front());
    });
    stays[static_cast<size_t>(far - open.begin())] = true;
  }
  Simplified out;
  const std::vector<bool> fixed = stays;
  size_t last = 0;
  for (size_t i = 1; i < open.size(); ++i) {
    if (!fixed[i]) continue;
    out.deviation = std::max(out.deviation, Mark(open, last, i, tolerance, stays));
    last = i;
  }
  for (size_t i = 0; i + (is_ring ? 1 : 0) < open.size(); ++i) {
    if (stays[i]) out.part.push_back(open[i]);
  }
  if (is_ring && out.part.size() < 3) out.part.clear();
  return out;
}

}  // namespace belvedere

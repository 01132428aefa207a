#include "managers/kept_triangles.h"

#include <glm/geometric.hpp>

#include <limits>

namespace belvedere {

// By how much errors on the screen may have grown since the choice; infinite where the choice is of something else.
double KeptTriangles::GrowthOfError(const Kept& kept, const CutNode& node, const Sight& sight) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const bool same = kept.page == node.page && kept.finest == node.finest &&
                    kept.sight.perspective == sight.perspective && kept.sight.cos_corner == sight.cos_corner;
  if (!same) return kNever;
  if (kept.error_scale == node.error_scale && kept.error_scale == 0) return 1.0;
  if (kept.error_scale == 0) return kNever;
  const double growth = node.error_scale / kept.error_scale;
  if (!sight.perspective) return growth;
  const double farthest_m = glm::distance(node.page->center_ecef, sight.eye_ecef) + node.page->radius_m;
  const double nearer_m = glm::distance(sight.eye_ecef, kept.sight.eye_ecef) +
                          glm::distance(sight.forward_ecef, kept.sight.forward_ecef) * farthest_m;
  if (nearer_m >= kept.nearest_depth_m) return nearer_m == 0 ? growth : kNever;
  return growth * kept.nearest_depth_m / (kept.nearest_depth_m - nearer_m);
}

KeptTriangles::Choice KeptTriangles::For(const CutNode& node, const Sight& sight, const Frame& frame, double error_px) {
  Kept& kept = kept_[node.node];
  const double growth = kept.page == nullptr ? std::numeric_limits<double>::infinity()
                                             : GrowthOfError(kept, node, sight) * kept.error_px / error_px;
  // Growth is at least 1 for an eye that moves; where errors shrink by more than the margin, fewer triangles would do.
  const bool holds = growth <= 1.0 + kKeepMargin && growth >= 1.0 - kKeepMargin;
  kept.list = list_;
  if (!holds) {
    ++chosen_;
    kept.page = node.page;
    kept.sight = sight;
    kept.error_scale = node.error_scale;
    kept.nearest_depth_m = node.nearest_depth_m;
    kept.error_px = error_px;
    kept.finest = node.finest;
    kept.triangles.clear();
    kept.worst = static_cast<double>(posts_.Run(node, sight, frame, error_px / (1.0 + kKeepMargin), kept.triangles)) /
                 (1.0 + kKeepMargin);
    return {kept.triangles, kept.worst};
  }
  return {kept.triangles, kept.worst * growth};
}

void KeptTriangles::ForgetUnused() {
  std::erase_if(kept_, [&](const auto& entry) { return entry.second.list != list_; });
  ++list_;
}

}  // namespace belvedere

#include "managers/kept_triangles.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

constexpr uint16_t kNoVertex = 0xFFFF;

constexpr bool IsBorderPost(int post) {
  const int column = post % kPosts;
  return column == 0 || column == kCells || post < kPosts || post >= kCells * kPosts;
}

// Greatest tangent of the angle to the line of view at which anything of the quadnode is seen.
double GreatestTangent(const TerrainPage& page, const Sight& sight) {
  const double of_corner = std::sqrt(1.0 / (sight.cos_corner * sight.cos_corner) - 1.0);
  const glm::dvec3 center_m = page.center_ecef - sight.eye_ecef;
  const double depth_m = glm::dot(center_m, sight.forward_ecef);
  if (depth_m <= page.radius_m) return of_corner;
  const double distance_m = glm::length(center_m);
  const double middle = std::sqrt(std::max(0.0, distance_m * distance_m - depth_m * depth_m)) / depth_m;
  // As far from its middle, on the plane at depth 1, as the sphere's points may lie.
  return std::min(of_corner, middle + page.radius_m * distance_m / (depth_m * (depth_m - page.radius_m)));
}

}  // namespace

KeptTriangles::KeptTriangles() {
  vertex_of_post_.fill(kNoVertex);
}

// Whether what was left out beside the picture lies there still.
bool KeptTriangles::StaysBeside(const Kept& kept, const Sight& sight) {
  if (!kept.beside) return true;
  double turned = 0;
  for (size_t side = 0; side < sight.inwards_ecef.size(); ++side)
    turned = std::max(turned, glm::distance(sight.inwards_ecef[side], kept.sight.inwards_ecef[side]));
  const double moved_m = glm::distance(sight.eye_ecef, kept.sight.eye_ecef);
  return moved_m <= (kBesideGuard - turned) * kept.nearest_depth_m;
}

// By how much errors on the screen may have grown since the choice; infinite where the choice is of something else.
double KeptTriangles::GrowthOfError(const Kept& kept, const CutNode& node, const Sight& sight) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const bool same = kept.page == node.page && kept.finest == node.finest &&
                    kept.sight.perspective == sight.perspective && kept.sight.cos_corner == sight.cos_corner;
  if (!same || !StaysBeside(kept, sight)) return kNever;
  if (kept.error_scale == node.error_scale && kept.error_scale == 0) return 1.0;
  if (kept.error_scale == 0) return kNever;
  const double growth = node.error_scale / kept.error_scale;
  if (!sight.perspective) return growth;
  const double moved_m = glm::distance(sight.eye_ecef, kept.sight.eye_ecef);
  if (moved_m > kKeepMargin * kept.nearest_depth_m) return kNever;
  const double nearer = moved_m == 0 ? 1.0 : kept.nearest_depth_m / (kept.nearest_depth_m - moved_m);
  const double turned = glm::distance(sight.forward_ecef, kept.sight.forward_ecef);
  const double turning = turned * GreatestTangent(*node.page, sight);
  const double deeper = 1.0 + turning;
  if (node.greatest_stretch == 0) return growth * nearer * deeper;
  const double stretch = deeper / (1.0 - turning - 0.5 * turned * turned);
  if (stretch < 0 || stretch > 1.0 + kKeepMargin) return kNever;
  return growth * nearer * deeper * std::max(1.0, stretch * kept.greatest_stretch / node.greatest_stretch);
}

void KeptTriangles::Choose(Kept& kept, const CutNode& node, const Sight& sight, const Frame& frame, double error_px) {
  ++chosen_;
  drawn_before_.clear();
  if (kept.page == node.page) {
    for (const ListVertex& vertex : kept.mesh.vertices) drawn_before_.push_back(static_cast<uint16_t>(vertex.post()));
  }
  kept.page = node.page;
  kept.sight = sight;
  kept.error_scale = node.error_scale;
  kept.greatest_stretch = node.greatest_stretch;
  kept.nearest_depth_m = node.nearest_depth_m;
  kept.error_px = error_px;
  kept.finest = node.finest;
  triangles_.clear();
  const double tighter_px = error_px / (1.0 + kKeepMargin);
  const auto leave_out_at = static_cast<float>(std::clamp(1.0 / error_px, 0.5, 1.0));
  kept.worst =
      static_cast<double>(posts_.Run(node, sight, frame, tighter_px, drawn_before_, leave_out_at, triangles_)) /
      (1.0 + kKeepMargin);
  kept.beside = posts_.left_out_beside();
  FillMesh(*node.page, kept.mesh);
}

void KeptTriangles::FillMesh(const TerrainPage& page, KeptMesh& mesh) {
  mesh.vertices.clear();
  mesh.inner.clear();
  mesh.at_border.clear();
  mesh.border_vertices.clear();
  bool on_border = false;
  const auto vertex_of = [&](uint16_t post) {
    const bool border = IsBorderPost(post);
    on_border |= border;
    uint16_t& vertex = vertex_of_post_[post];
    if (vertex != kNoVertex) return vertex;
    vertex = static_cast<uint16_t>(mesh.vertices.size());
    const TerrainVertex& of_page = page.vertices[post];
    mesh.vertices.push_back({of_page.x, of_page.y, of_page.z, of_page.normal, post, 0.0F});
    if (border) mesh.border_vertices.push_back(vertex);
    return vertex;
  };
  for (const PostTriangle& posts : triangles_) {
    on_border = false;
    const KeptMesh::Triangle triangle{vertex_of(posts.a), vertex_of(posts.b), vertex_of(posts.c)};
    (on_border ? mesh.at_border : mesh.inner).push_back(triangle);
  }
  for (const ListVertex& vertex : mesh.vertices) vertex_of_post_[vertex.post()] = kNoVertex;
}

KeptTriangles::Choice KeptTriangles::For(const CutNode& node, const Sight& sight, const Frame& frame, double error_px) {
  Kept& kept = kept_[node.node];
  const double growth = kept.page == nullptr ? std::numeric_limits<double>::infinity()
                                             : GrowthOfError(kept, node, sight) * kept.error_px / error_px;
  // Growth is at least 1 for an eye that moves; where errors shrink by more than the margin, fewer triangles would do.
  const bool holds = growth <= 1.0 + kKeepMargin && growth >= 1.0 - kKeepMargin;
  kept.list = list_;
  if (!holds) Choose(kept, node, sight, frame, error_px);
  return {&kept.mesh, holds ? kept.worst * growth : kept.worst, !holds};
}

std::vector<Quadcode> KeptTriangles::Unused() const {
  std::vector<Quadcode> unused;
  for (const auto& [node, kept] : kept_) {
    if (kept.list != list_) unused.push_back(node);
  }
  return unused;
}

void KeptTriangles::ForgetUnused() {
  std::erase_if(kept_, [&](const auto& entry) { return entry.second.list != list_; });
  ++list_;
}

}  // namespace belvedere

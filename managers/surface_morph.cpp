#include "managers/surface_morph.h"

#include "managers/picture_sides.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace belvedere {
namespace {

constexpr uint32_t kEmpty = 0xFFFFFFFF;
constexpr int kMostAncestors = 8;  // between a quadnode and what was drawn in its place, to be worth a search

// Where the posts of a quadnode lie on the grid.
struct PostGrid {
  GridPoint corner;
  uint32_t east, north;  // from post to post
  explicit PostGrid(Quadcode node)
      : corner(node.SouthWest()), east(node.PostSpacingEast()), north(node.PostSpacingNorth()) {}
  GridPoint At(uint32_t post) const { return {corner.x + post % kPosts * east, corner.y + post / kPosts * north}; }
};

bool IsPole(GridPoint position) {
  return position.y == 0 || position.y == kGridNorthPole;
}

size_t HashOf(GridPoint position, size_t mask) {
  const uint64_t mixed = (uint64_t{position.x} << 32 | position.y) * 0x9E3779B97F4A7C15U;
  return (mixed >> 32) & mask;
}

double PixelsPerMetre(const CutNode& node) {
  return node.nearest_depth_m > 0 ? node.error_scale / node.nearest_depth_m : node.error_scale;
}

// What is left of a rise; the shader's formula.
double LeftAt(double now_s, double from_s, double rise_s) {
  return rise_s > 0 ? std::clamp(1.0 - (now_s - from_s) / rise_s, 0.0, 1.0) : 0.0;
}

glm::vec3 UpIn(const Frame& frame, const glm::vec3& point) {
  return glm::normalize(glm::vec3(glm::dvec3(point) - frame.ToFrame(glm::dvec3(0))));
}

// Where the post is, every triangle that it is a corner of lies beside the picture. A neighbour's may be larger than
// the post's own: borders are left out.
bool IsUnseen(const PictureSides& sides, const TerrainPage& page, Post post, const glm::vec3& place) {
  const bool inner = post.column > 0 && post.column < kCells && post.row > 0 && post.row < kCells;
  return inner && sides.IsBeyond(place, page.spread_m[static_cast<size_t>(LevelOf(post))], 0);
}

glm::vec3 PointOf(const ListVertex& vertex) {
  return {vertex.x, vertex.y, vertex.z};
}

}  // namespace

// Where the old surface was at the posts of one quadnode, in its frame.
class OldSurface {
 public:
  OldSurface(SurfaceMorph& morph, Quadcode node, const Frame& frame)
      : morph_(morph), node_(node), grid_(node), frame_(frame) {
    morph.found_.resize(kVerticesPerPage);
    ++morph.round_;
  }

  std::optional<glm::vec3> At(Post post) {
    SurfaceMorph::Found& found = morph_.found_[static_cast<size_t>(post.index())];
    if (found.round == morph_.round_) return found.point;
    found.round = morph_.round_;
    found.point = Find(post);
    return found.point;
  }

 private:
  std::optional<glm::vec3> Find(Post post) {
    const GridPoint position = grid_.At(static_cast<uint32_t>(post.index()));
    if (IsPole(position)) return std::nullopt;
    if (const auto old = morph_.OldVertexAt(position)) return morph_.OldPointIn(frame_, *old);
    if (LevelOf(post) == kNoLevel) {
      const auto ecef = OfAncestor(node_, post, kMostAncestors);
      return ecef ? std::optional(glm::vec3(frame_.ToFrame(*ecef))) : std::nullopt;
    }
    const Split split = SplitAt(post);
    const auto a = At(split.end_a);
    const auto b = At(split.end_b);
    if (!a || !b) return std::nullopt;
    return 0.5F * (*a + *b);
  }

  // At a corner of a quadnode, in ECEF, found among the posts of its parent.
  std::optional<glm::dvec3> OfAncestor(Quadcode node, Post corner, int ancestors_left) {
    if (node.is_root() || ancestors_left == 0) return std::nullopt;
    const Quadcode parent = node.Parent();
    const GridPoint position = PostGrid(node).At(static_cast<uint32_t>(corner.index()));
    const GridPoint origin = parent.SouthWest();
    return AmongPosts(parent,
                      {static_cast<int>((position.x - origin.x) / parent.PostSpacingEast()),
                       static_cast<int>((position.y - origin.y) / parent.PostSpacingNorth())},
                      ancestors_left - 1);
  }
  std::optional<glm::dvec3> AmongPosts(Quadcode node, Post post, int ancestors_left) {
    const GridPoint position = PostGrid(node).At(static_cast<uint32_t>(post.index()));
    if (IsPole(position)) return std::nullopt;
    if (const auto old = morph_.OldVertexAt(position)) return morph_.OldPointEcef(*old);
    if (LevelOf(post) == kNoLevel) return OfAncestor(node, post, ancestors_left);
    const Split split = SplitAt(post);
    const auto a = AmongPosts(node, split.end_a, ancestors_left);
    const auto b = AmongPosts(node, split.end_b, ancestors_left);
    if (!a || !b) return std::nullopt;
    return 0.5 * (*a + *b);
  }

  SurfaceMorph& morph_;
  const Quadcode node_;
  const PostGrid grid_;
  const Frame& frame_;
};

void SurfaceMorph::Begin(double now_s, bool jump) {
  now_s_ = now_s;
  jump_ = jump || !old_vertices_ || old_vertices_->empty();
}

void SurfaceMorph::Place(const CutNode& node, const Sight& sight, const Frame& frame, bool is_new, KeptMesh& mesh) {
  if (jump_ || !node.visible) {
    if (!is_new && mesh.rises_until_s <= mesh.rises_from_s) return;
    for (ListVertex& vertex : mesh.vertices) vertex.rise_m = 0;
    mesh.rises_from_s = mesh.rises_until_s = 0;
    return;
  }
  if (is_new) return PlaceNew(node, sight, frame, mesh);
  if (mesh.rises_until_s <= mesh.rises_from_s) return;
  const auto left = static_cast<float>(LeftAt(now_s_, mesh.rises_from_s, mesh.rises_until_s - mesh.rises_from_s));
  for (ListVertex& vertex : mesh.vertices) vertex.rise_m *= left;
  mesh.rises_from_s = now_s_;
  if (mesh.rises_until_s <= now_s_) mesh.rises_from_s = mesh.rises_until_s = 0;
}

void SurfaceMorph::PlaceNew(const CutNode& node, const Sight& sight, const Frame& frame, KeptMesh& mesh) {
  OldSurface old(*this, node.node, frame);
  const PictureSides sides(node, sight, frame);
  const double least_m = kUnseen_px / PixelsPerMetre(node);
  double most_m = 0;
  for (ListVertex& vertex : mesh.vertices) {
    const auto index = static_cast<int>(vertex.post());
    const Post post{index % kPosts, index / kPosts};
    const glm::vec3 place = PointOf(vertex);
    if (sides.any() && IsUnseen(sides, *node.page, post, place)) continue;
    const auto point = old.At(post);
    if (!point || *point == place) continue;
    const float rise_m = glm::dot(*point - place, UpIn(frame, place));
    if (std::abs(rise_m) < least_m) continue;
    vertex.rise_m = rise_m;
    most_m = std::max(most_m, static_cast<double>(std::abs(rise_m)));
  }
  mesh.rises_from_s = mesh.rises_until_s = 0;
  Schedule(node, most_m, mesh);
}

void SurfaceMorph::PlaceShared(const CutNode& node, const Frame& frame, uint16_t vertex, KeptMesh& mesh) {
  if (jump_ || !node.visible) return;
  ListVertex& shared = mesh.vertices[vertex];
  const GridPoint position = PostGrid(node.node).At(shared.post());
  if (IsPole(position)) return;
  const auto old = OldVertexAt(position);
  if (!old || old_draws_[(*old_vertices_)[*old].draw()].node == node.node) return;
  const glm::vec3 place = PointOf(shared);
  const glm::vec3 point = OldPointIn(frame, *old);
  const float rise_m = glm::dot(point - place, UpIn(frame, place));
  if (std::abs(rise_m - shared.rise_m) < kUnseen_px / PixelsPerMetre(node)) return;
  shared.rise_m = rise_m;
  Schedule(node, std::abs(rise_m), mesh);
}

// REQUIRES: rises are of now.
void SurfaceMorph::Schedule(const CutNode& node, double most_m, KeptMesh& mesh) const {
  if (most_m == 0) return;
  const double rise_s = std::clamp(most_m * PixelsPerMetre(node) / kSpeed_px_s, kLeast_s, kMost_s);
  mesh.rises_from_s = now_s_;
  mesh.rises_until_s = std::max(mesh.rises_until_s, now_s_ + rise_s);
}

void SurfaceMorph::Remember(const DisplayList& list, std::span<const uint32_t> ranked,
                            std::span<const uint32_t> first_vertex) {
  old_s_ = now_s_;
  old_vertices_ = list.vertices;
  old_draws_.clear();
  for (const TerrainDraw& draw : list.terrain_draws) old_draws_.push_back({draw.node, draw.frame, draw.rise_s});
  old_frames_ = list.frames;
  old_ranked_.assign(ranked.begin(), ranked.end());
  old_first_vertex_.assign(first_vertex.begin(), first_vertex.end());
}

void SurfaceMorph::Prepare(const std::unordered_map<Quadcode, const KeptMesh*>& unchanged) {
  if (jump_) return;
  const std::vector<ListVertex>& vertices = *old_vertices_;
  table_.assign(std::bit_ceil(2 * vertices.size() + 1), kEmpty);
  positions_.resize(vertices.size());
  for (const uint32_t draw : old_ranked_) {
    const PostGrid grid(old_draws_[draw].node);
    const uint32_t first = old_first_vertex_[draw];
    if (const auto found = unchanged.find(old_draws_[draw].node); found != unchanged.end()) {
      if (found->second == nullptr) continue;
      for (const uint16_t own : found->second->border_vertices) {
        Index(first + own, grid.At(vertices[first + own].post()));
      }
      continue;
    }
    const size_t end = draw + 1 < old_first_vertex_.size() ? old_first_vertex_[draw + 1] : vertices.size();
    for (uint32_t vertex = first; vertex < end; ++vertex) Index(vertex, grid.At(vertices[vertex].post()));
  }
}

void SurfaceMorph::Index(uint32_t vertex, GridPoint position) {
  const size_t mask = table_.size() - 1;
  positions_[vertex] = position;
  size_t entry = HashOf(position, mask);
  // Of several at one place the first is the one that is drawn.
  while (table_[entry] != kEmpty && positions_[table_[entry]] != position) entry = (entry + 1) & mask;
  if (table_[entry] == kEmpty) table_[entry] = vertex;
}

std::optional<uint32_t> SurfaceMorph::OldVertexAt(GridPoint position) const {
  const size_t mask = table_.size() - 1;
  for (size_t entry = HashOf(position, mask); table_[entry] != kEmpty; entry = (entry + 1) & mask) {
    if (positions_[table_[entry]] == position) return table_[entry];
  }
  return std::nullopt;
}

glm::vec3 SurfaceMorph::OldPointIn(const Frame& frame, uint32_t vertex) const {
  const ListVertex& old = (*old_vertices_)[vertex];
  const OldDraw& draw = old_draws_[old.draw()];
  const Frame& old_frame = old_frames_[draw.frame];
  glm::vec3 point = PointOf(old);
  const auto rise_m = old.rise_m * static_cast<float>(LeftAt(now_s_, old_s_, static_cast<double>(draw.rise_s)));
  if (rise_m != 0) point += rise_m * UpIn(old_frame, point);
  return old_frame.node == frame.node ? point : glm::vec3(frame.ToFrame(old_frame.ToEcef(point)));
}

glm::dvec3 SurfaceMorph::OldPointEcef(uint32_t vertex) const {
  const Frame& old_frame = old_frames_[old_draws_[(*old_vertices_)[vertex].draw()].frame];
  return old_frame.ToEcef(OldPointIn(old_frame, vertex));
}

}  // namespace belvedere

#include "managers/post_selection.h"

#include "managers/picture_sides.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

constexpr float kAlwaysDrawn_m = 12'000.0F;  // delta value from which a post is drawn whatever the view
constexpr float kLeastDepth_m = 1e-3F;
// The ellipsoid's radii of curvature, 6335 to 6400 km, are this one but for kCurvatureSpread of it.
constexpr double kCurvature_m = 6'367'400.0;
constexpr double kCurvatureSpread = 0.006;

constexpr int kSouthWest = Post{0, 0}.index();
constexpr int kSouthEast = Post{kCells, 0}.index();
constexpr int kNorthWest = Post{0, kCells}.index();
constexpr int kNorthEast = Post{kCells, kCells}.index();

}  // namespace

// One quadnode and the view of it, in the quadnode's frame.
struct PostSelection::LocalView {
  const TerrainPage& page;
  glm::vec3 eye;
  glm::vec3 forward;
  float cos_corner;
  bool perspective;
  float scale;             // error in metres times this is the least depth at which it keeps the bound
  float nearest_depth_m;   // CutNode::nearest_depth_m
  float left_over_m;       // what the quadnode leaves whatever is drawn
  float greatest_stretch;  // CutNode::greatest_stretch
  float widest;            // W of the header
  float moved_m;           // as far may the eye move
  float tilt;              // by which the vertical of a post may be wrong, radians
  PictureSides sides;

  LocalView(const CutNode& node, const Sight& sight, const Frame& frame, double error_px)
      : page(*node.page),
        eye(frame.ToFrame(sight.eye_ecef)),
        forward(sight.forward_ecef * frame.ecef_from_frame),
        cos_corner(static_cast<float>(sight.cos_corner)),
        perspective(sight.perspective),
        scale(static_cast<float>(node.error_scale / error_px)),
        nearest_depth_m(static_cast<float>(node.nearest_depth_m)),
        left_over_m(node.finest ? 0.0F : page.error_m),
        greatest_stretch(static_cast<float>(node.greatest_stretch)),
        widest(static_cast<float>((1.0 + kKeepMargin) / sight.cos_corner)),
        moved_m(static_cast<float>(kKeepMargin * node.nearest_depth_m)),
        tilt(static_cast<float>(GreatestTilt(page, frame))),
        sides(node, sight, frame) {}

  // Of the ellipsoid's verticals from those of the sphere, which are a little short where the ground is below it.
  static double GreatestTilt(const TerrainPage& page, const Frame& frame) {
    const double from_origin_m = glm::distance(page.center_ecef, frame.origin_ecef) + page.radius_m;
    return (kCurvatureSpread * from_origin_m - std::min(0.0, double{page.min_height_m})) / kCurvature_m;
  }

  // Of the triangles that the post splits, by their corners: the least depth, also of what lies delta_m over or under
  // them, and the greatest g as a share of the quadnode's. A view without a greatest g, an orthographic one, has none.
  struct Corners {
    float least_depth_m = kLeastDepth_m;
    float share_of_greatest = 1;
  };
  Corners LookAtCorners(Post post, int level, float delta_m) const {
    constexpr auto kPerMetre = static_cast<float>(1.0 / kCurvature_m);
    const glm::vec3 up = glm::vec3(0, 0, 1) + PlaceOfPost(post) * kPerMetre;
    const float along = glm::dot(up, forward);
    float least_depth_m = std::numeric_limits<float>::max();
    float stretch = 0;
    const Split split = SplitAt(post);
    for (const Post corner : {split.end_a, split.end_b, split.apex_a, split.apex_b}) {
      if (!corner.inside()) continue;
      const glm::vec3 away = PlaceOfPost(corner) - eye;
      const float depth_m = glm::dot(away, forward);
      if (depth_m <= kLeastDepth_m) return {};  // what is behind the eye has no place in the picture
      least_depth_m = std::min(least_depth_m, depth_m);
      stretch = std::max(stretch, glm::length(up * depth_m - along * away) / depth_m);
    }
    stretch += widest * (std::abs(along) * moved_m / least_depth_m +
                         page.spread_m[static_cast<size_t>(level)] * kPerMetre + tilt);
    return {least_depth_m - delta_m * std::abs(along), std::min(1.0F, stretch / greatest_stretch)};
  }

  glm::vec3 PlaceOfPost(Post post) const { return PlaceOf(page.vertices[static_cast<size_t>(post.index())]); }

  // All triangles that the post splits, and what lies delta_m over or under them, lie beside the picture, and well so.
  bool IsBeside(Post post, int level, float delta_m) const {
    constexpr auto kGuard = static_cast<float>(kBesideGuard);
    if (sides.IsBeyond(PlaceOfPost(post), page.spread_m[static_cast<size_t>(level)], kGuard)) return true;
    std::array<glm::vec3, 4> corners{};
    size_t count = 0;
    const Split split = SplitAt(post);
    for (const Post corner : {split.end_a, split.end_b, split.apex_a, split.apex_b}) {
      if (corner.inside()) corners[count++] = PlaceOfPost(corner);
    }
    return sides.AreBeyond(std::span(corners).first(count), delta_m, kGuard);
  }

  // Least depth of any point of the triangles that the post splits.
  float LeastDepth(Post post, int level) const {
    const float spread_m = page.spread_m[static_cast<size_t>(level)];
    const glm::vec3 away = PlaceOfPost(post) - eye;
    // What is seen lies within cos_corner of the line of view; what lies beside the picture counts as if it did.
    return std::max({nearest_depth_m, glm::dot(away, forward) - spread_m, (glm::length(away) - spread_m) * cos_corner});
  }
};

float PostSelection::Run(const CutNode& node, const Sight& sight, const Frame& frame, double error_px,
                         std::span<const uint16_t> drawn_before, float leave_out_at, std::vector<PostTriangle>& out) {
  const LocalView view(node, sight, frame, error_px);
  states_.fill(kUnseen);
  stay_ = 1.0F / leave_out_at;
  for (const uint16_t post : drawn_before) states_[post] = kDrawnBefore;
  for (const int corner : {kSouthWest, kSouthEast, kNorthWest, kNorthEast})
    states_[static_cast<size_t>(corner)] = kDrawn;
  worst_ = 0;
  left_out_beside_ = false;
  drawn_.clear();
  Test(Post{kCells / 2, kCells / 2}, 0, view);
  // In the order in which they were found: what Draw has asked of memory for a post has come when its turn does.
  for (size_t next = 0; next < drawn_.size(); ++next) {
    const int index = drawn_[next];
    const Post post{index % kPosts, index / kPosts};
    const Split split = SplitAt(post);
    for (const Post parent : {split.apex_a, split.apex_b}) {
      if (parent.inside()) Draw(parent, view);
    }
    const int level = LevelOf(post);
    if (level + 1 == kBisectionLevels) continue;
    for (const Post child : ChildrenOf(post)) {
      if (child.inside()) Test(child, level + 1, view);
    }
  }
  Emit(kSouthEast, kNorthEast, kSouthWest, 0, out);
  Emit(kNorthWest, kSouthWest, kNorthEast, 0, out);
  return worst_;
}

void PostSelection::Draw(Post post, const LocalView& view) {
  State& state = states_[static_cast<size_t>(post.index())];
  if (state == kDrawn) return;
  state = kDrawn;
  drawn_.push_back(static_cast<uint16_t>(post.index()));
  if (LevelOf(post) + 1 == kBisectionLevels) return;
  for (const Post child : ChildrenOf(post)) {
    if (!child.inside()) continue;
    __builtin_prefetch(&view.page.deltas[static_cast<size_t>(child.index())]);
    __builtin_prefetch(&view.page.vertices[static_cast<size_t>(child.index())]);
  }
}

void PostSelection::Test(Post post, int level, const LocalView& view) {
  const auto index = static_cast<size_t>(post.index());
  const State state = states_[index];
  if (state == kDrawn || state == kLeftOut) return;
  const float delta_m = view.page.deltas[index];
  // Whoever jumps to the other side of the world finds it round, also in the list that was made before the jump.
  if (delta_m > kAlwaysDrawn_m) return Draw(post, view);
  // A quadnode that must serve although its own posts are too coarse draws what matters beside what it leaves anyhow.
  float error = std::max(0.0F, delta_m - view.left_over_m) * view.scale;
  // Most posts are done with before their place is looked up in memory.
  float least_depth_m = view.perspective ? view.nearest_depth_m : 1.0F;
  const float stay = state == kDrawnBefore ? stay_ : 1.0F;
  if (error * stay > least_depth_m && view.perspective) least_depth_m = view.LeastDepth(post, level);
  least_depth_m = std::max(least_depth_m, kLeastDepth_m);
  if (error * stay > least_depth_m && view.greatest_stretch > 0) {
    const LocalView::Corners corners = view.LookAtCorners(post, level, delta_m);
    error *= corners.share_of_greatest;
    least_depth_m = std::max(least_depth_m, corners.least_depth_m);
  }
  if (error * stay > least_depth_m && view.sides.any() && view.IsBeside(post, level, delta_m)) {
    error *= static_cast<float>(kShareBesidePicture);
    left_out_beside_ |= error * stay <= least_depth_m;
  }
  if (error * stay > least_depth_m) return Draw(post, view);
  states_[index] = kLeftOut;
  worst_ = std::max(worst_, error / least_depth_m);
}

void PostSelection::Emit(int a, int b, int c, int level, std::vector<PostTriangle>& out) const {
  if (level < kBisectionLevels) {
    const int middle = (b + c) / 2;  // exact in posts numbered row by row: rows and columns halve separately
    if (states_[static_cast<size_t>(middle)] == kDrawn) {
      Emit(middle, a, b, level + 1, out);
      Emit(middle, c, a, level + 1, out);
      return;
    }
  }
  out.push_back({static_cast<uint16_t>(a), static_cast<uint16_t>(b), static_cast<uint16_t>(c)});
}

}  // namespace belvedere

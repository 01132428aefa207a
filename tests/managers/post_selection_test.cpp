#include "managers/post_selection.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace belvedere {
namespace {

using test::FlatPage;
using test::RandomDeltas;

constexpr double kErrorPx = 0.5;

struct Scene {
  std::unique_ptr<TerrainPage> page;
  CutNode node;
  Sight sight;
  std::vector<PostTriangle> triangles;
  float worst = 0;

  explicit Scene(uint32_t seed, double error_px = kErrorPx) {
    std::mt19937 random(seed);
    page = FlatPage(Quadcode::Containing(37, -118, 6), RandomDeltas(random));
    node.node = page->node;
    node.page = page.get();
    node.error_scale = 700;
    sight.eye_ecef = ToEcef({36.9, -118.2, 60'000});
    sight.forward_ecef = glm::normalize(ToEcef({37.3, -117.6, 0}) - sight.eye_ecef);
    sight.cos_corner = 0.7;
    worst = PostSelection().Run(node, sight, FrameOf(page->node), error_px, {}, 1.0F, triangles);
  }

  // Screen-space error of the post's delta value, were it at the depth of `where`; 0 behind the eye.
  double ErrorAt(int post, int where) const {
    const TerrainVertex& v = page->vertices[static_cast<size_t>(where)];
    const glm::dvec3 away = FrameOf(page->node).ToEcef({v.x, v.y, v.z}) - sight.eye_ecef;
    const double depth = std::max(glm::dot(away, sight.forward_ecef), sight.cos_corner * glm::length(away));
    return page->deltas[static_cast<size_t>(post)] * node.error_scale / depth;
  }
};

TEST(PostSelection, NoTriangleIsOverTheBoundAnywhere) {
  const Scene scene(1);
  ASSERT_GT(scene.triangles.size(), 1000U);
  ASSERT_LT(scene.triangles.size(), 2U * kCells * kCells);
  size_t whole = 0;
  for (const PostTriangle& triangle : scene.triangles) {
    const int middle = (triangle.b + triangle.c) / 2;
    if ((triangle.b + triangle.c) % 2 != 0) continue;
    const Post post{middle % kPosts, middle / kPosts};
    const bool splits = LevelOf(post) != kNoLevel && std::abs(triangle.b % kPosts - triangle.c % kPosts) % 2 == 0 &&
                        std::abs(triangle.b / kPosts - triangle.c / kPosts) % 2 == 0;
    if (!splits) continue;  // as small as triangles get
    ++whole;
    for (const int corner : {int{triangle.a}, int{triangle.b}, int{triangle.c}, middle})
      ASSERT_LE(scene.ErrorAt(middle, corner), kErrorPx * 1.001);
  }
  EXPECT_GT(whole, 500U);
}

// What the page leaves whatever is drawn is taken off every delta value before it counts.
TEST(PostSelection, AQuadnodeThatServesAlthoughItIsTooCoarseDrawsWhatMattersBesideThat) {
  Scene scene(3);
  const auto draw = [&](float error_m, bool finest) {
    std::vector<PostTriangle> triangles;
    scene.page->error_m = error_m;
    scene.node.finest = finest;
    PostSelection().Run(scene.node, scene.sight, FrameOf(scene.page->node), kErrorPx, {}, 1.0F, triangles);
    return triangles.size();
  };
  const float greatest = *std::max_element(scene.page->deltas.begin(), scene.page->deltas.end());
  const size_t whole = draw(0.1F * greatest, true);
  const size_t less = draw(0.1F * greatest, false);
  EXPECT_EQ(whole, scene.triangles.size());
  EXPECT_LT(less, whole);
  EXPECT_GT(less, 2U);
  for (float& delta : scene.page->deltas) delta = std::max(0.0F, delta - 0.1F * greatest);
  EXPECT_EQ(draw(0, true), less);
  EXPECT_EQ(draw(greatest, false), 2U);
}

// From wherever the eye looks, near and far, at whatever slant; and with far fewer triangles than for the greatest g
// that there is anywhere.
TEST(PostSelection, ShiftsAlongTheVerticalKeepTheBound) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  size_t by_post = 0, by_quadnode = 0;
  double largest_px = 0;
  for (int eye = 0; eye < 40; ++eye) {
    const auto page =
        FlatPage(Quadcode::Containing(75 * unit(random), 170 * unit(random), 1 + eye % 10), RandomDeltas(random));
    const double size_m = page->radius_m;
    const GeoBox box = page->node.Box();
    const double size_deg = page->node.HeightDegrees();
    const auto near = [&](double middle_deg, double share) { return middle_deg + share * size_deg * unit(random); };
    const Geodetic place{near(0.5 * (box.south_deg + box.north_deg), 0.7),
                         near(0.5 * (box.west_deg + box.east_deg), 0.7), size_m * std::exp2(2 * unit(random))};
    Sight sight;
    sight.eye_ecef = ToEcef(place);
    sight.forward_ecef = glm::normalize(page->center_ecef - sight.eye_ecef +
                                        0.7 * size_m * glm::dvec3(unit(random), unit(random), unit(random)));
    sight.cos_corner = 0.7;
    const double pixels_per_radian = 0.01 * place.height_m;  // delta values are not larger where quadnodes are
    CutNode node;
    node.node = page->node;
    node.page = page.get();
    node.greatest_stretch = 1 / sight.cos_corner;
    node.error_scale = pixels_per_radian * node.greatest_stretch;
    std::vector<PostTriangle> triangles, coarser;
    PostSelection().Run(node, sight, FrameOf(page->node), kErrorPx, {}, 1.0F, triangles);
    for (const auto& [a, b, c] : triangles) {
      const double error_px = test::SeenErrorOfTriangle_px(*page, {a, b, c}, sight, pixels_per_radian);
      ASSERT_LE(error_px, kErrorPx * 1.001) << page->node.level();
      largest_px = std::max(largest_px, error_px);
    }
    by_post += triangles.size();
    node.greatest_stretch = 0;
    PostSelection().Run(node, sight, FrameOf(page->node), kErrorPx, {}, 1.0F, coarser);
    by_quadnode += coarser.size();
  }
  EXPECT_GT(largest_px, 0.97 * kErrorPx);
  EXPECT_LT(by_post, 0.85 * static_cast<double>(by_quadnode));
}

// The fewest: a post is drawn because its own triangles ask for it, or because one that depends on it is drawn.
TEST(PostSelection, DrawsNoPostWithoutAReason) {
  const Scene scene(2);
  std::set<int> drawn;
  for (const PostTriangle& triangle : scene.triangles) drawn.insert({triangle.a, triangle.b, triangle.c});
  for (const int index : drawn) {
    const Post post{index % kPosts, index / kPosts};
    const int level = LevelOf(post);
    if (level == kNoLevel) continue;
    bool has_reason = false;
    if (level + 1 < kBisectionLevels) {
      for (const Post child : ChildrenOf(post)) has_reason |= child.inside() && drawn.contains(child.index());
    }
    if (has_reason) continue;
    const double delta_m = scene.page->deltas[static_cast<size_t>(index)];
    const TerrainVertex& v = scene.page->vertices[static_cast<size_t>(index)];
    const glm::dvec3 away = FrameOf(scene.page->node).ToEcef({v.x, v.y, v.z}) - scene.sight.eye_ecef;
    const double spread_m = scene.page->spread_m[static_cast<size_t>(level)];
    const double nearest_m = std::max({0.0, glm::dot(away, scene.sight.forward_ecef) - spread_m,
                                       (glm::length(away) - spread_m) * scene.sight.cos_corner});
    ASSERT_GT(delta_m * scene.node.error_scale, nearest_m * kErrorPx * 0.999);
  }
}

TEST(PostSelection, EveryPostHasItsParents) {
  const Scene scene(3);
  std::set<int> drawn;
  for (const PostTriangle& triangle : scene.triangles) drawn.insert({triangle.a, triangle.b, triangle.c});
  for (const int index : drawn) {
    const Post post{index % kPosts, index / kPosts};
    if (LevelOf(post) == kNoLevel) continue;
    const Split split = SplitAt(post);
    for (const Post parent : {split.apex_a, split.apex_b}) {
      if (!parent.inside()) continue;
      ASSERT_TRUE(drawn.contains(parent.index()));
    }
  }
}

TEST(PostSelection, TrianglesCoverTheQuadnodeOnce) {
  const Scene scene(4);
  int64_t twice_area = 0;
  for (const PostTriangle& t : scene.triangles) {
    const auto x = [](int post) { return int64_t{post % kPosts}; };
    const auto y = [](int post) { return int64_t{post / kPosts}; };
    const int64_t twice = (x(t.b) - x(t.a)) * (y(t.c) - y(t.a)) - (x(t.c) - x(t.a)) * (y(t.b) - y(t.a));
    ASSERT_GT(twice, 0) << "clockwise or without area";
    twice_area += twice;
  }
  EXPECT_EQ(twice_area, 2 * int64_t{kCells} * kCells);
}

TEST(PostSelection, ReportsTheWorstOfWhatIsLeftOut) {
  const Scene scene(5);
  EXPECT_GT(scene.worst, 0.5F);
  EXPECT_LE(scene.worst, 1.0F);
}

// Beside the picture a share of the error counts, within it all of it; triangles there do not know of the picture.
TEST(PostSelection, IsCoarserBesideThePicture) {
  const Scene whole(6);
  const glm::dvec3 side = glm::normalize(glm::cross(whole.sight.forward_ecef, whole.sight.eye_ecef));
  const auto chosen = [&](const glm::dvec3& inward_ecef, bool* left_out) {
    Sight sight = whole.sight;
    sight.inwards_ecef[1] = inward_ecef;
    PostSelection selection;
    std::vector<PostTriangle> triangles;
    EXPECT_LE(selection.Run(whole.node, sight, FrameOf(whole.page->node), kErrorPx, {}, 1.0F, triangles), 1.0F);
    *left_out = selection.left_out_beside();
    return triangles;
  };
  bool left_out = false;
  const std::vector<PostTriangle> half = chosen(side, &left_out);
  EXPECT_TRUE(left_out);
  EXPECT_LT(half.size() + 1000, whole.triangles.size());

  const auto in_picture = [&](const PostTriangle& triangle) {
    const auto is_in = [&](int post) {
      const TerrainVertex& v = whole.page->vertices[static_cast<size_t>(post)];
      return glm::dot(FrameOf(whole.page->node).ToEcef({v.x, v.y, v.z}) - whole.sight.eye_ecef, side) >= 0;
    };
    return is_in(triangle.a) && is_in(triangle.b) && is_in(triangle.c);
  };
  const auto key = [](const PostTriangle& t) { return std::array{t.a, t.b, t.c}; };
  std::set<std::array<uint16_t, 3>> kept;
  for (const PostTriangle& triangle : half) kept.insert(key(triangle));
  size_t seen = 0;
  for (const PostTriangle& triangle : whole.triangles) {
    if (!in_picture(triangle)) continue;
    ++seen;
    ASSERT_TRUE(kept.contains(key(triangle)));
  }
  EXPECT_GT(seen, 100U);

  EXPECT_EQ(chosen(glm::dvec3(0), &left_out).size(), whole.triangles.size());
  EXPECT_FALSE(left_out) << "the sides of the picture are not known";
}

TEST(PostSelection, FlatGroundIsTwoTriangles) {
  const auto page = FlatPage(Quadcode::Containing(37, -118, 12), std::vector<float>(kVerticesPerPage, 0.0F));
  CutNode node;
  node.node = page->node;
  node.page = page.get();
  node.error_scale = 700;
  std::vector<PostTriangle> triangles;
  EXPECT_EQ(PostSelection().Run(node, Sight{}, FrameOf(page->node), 1.0, {}, 1.0F, triangles), 0.0F);
  EXPECT_EQ(triangles.size(), 2U);
}

}  // namespace
}  // namespace belvedere

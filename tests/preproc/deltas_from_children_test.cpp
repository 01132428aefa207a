// The builder's delta values against the finest surface itself, looked up at all its posts.

#include "preproc/deltas_from_children.h"

#include "runtime/earth/bisection.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/delta_values.h"
#include "runtime/paging/stored_deltas.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

// Hills at every scale, so that each level of pages adds some.
double Rough(GridPoint point) {
  double height_m = 1000;
  double amplitude_m = 800;
  for (double frequency = 3; frequency < 3e5; frequency *= 2.3) {
    height_m += amplitude_m * std::sin(point.longitude_deg() * frequency + 1.7) *
                std::sin(point.latitude_deg() * frequency * 0.9 + 0.3);
    amplitude_m *= 0.5;
  }
  return height_m;
}

// A page, and those under it down to a level, as the builder makes them.
class Pages {
 public:
  Pages(Quadcode root, int levels) { Make(root, levels); }
  const ElevationPage& at(Quadcode node) const { return *pages_.at(node); }
  bool has(Quadcode node) const { return pages_.contains(node); }

 private:
  BoundedPage Make(Quadcode node, int levels) {
    std::shared_ptr<ElevationPage> page = MakeElevation(node, Rough);
    std::array<BoundedPage, 4> children;
    if (levels > 0) {
      for (const int which : node.Children())
        children[static_cast<size_t>(which)] = Make(node.Child(which), which == 2 ? levels - 1 : 0);
      HalveWide(node, children);
    }
    CellDeviations deviations = BoundPage(*page, levels > 0 ? &children : nullptr);
    if (levels > 0) page->deltas = DeltasFromChildren(node, *page, children);
    pages_[node] = page;
    return {page, std::move(deviations)};
  }
  std::map<Quadcode, std::shared_ptr<const ElevationPage>> pages_;
};

// Where the node's post (column, row) is.
glm::dvec3 PlaceOf(Quadcode node, const ElevationPage& page, int column, int row) {
  const GridPoint corner = node.SouthWest();
  const GridPoint point{corner.x + static_cast<uint32_t>(column) * node.PostSpacingEast(),
                        corner.y + static_cast<uint32_t>(row) * node.PostSpacingNorth()};
  return ToEcef({point.latitude_deg(), point.longitude_deg(), page.at(column, row) * 1e-3});
}

// The greatest distance of the finest posts within the two triangles that the post splits.
double GreatestDistance(const Pages& pages, Quadcode root, Post post) {
  const ElevationPage& page = pages.at(root);
  const Split split = SplitAt(post);
  double greatest = 0;
  const auto add_triangle = [&](Post a, Post b, Post c) {
    const glm::dvec3 at_a = PlaceOf(root, page, a.column, a.row), at_b = PlaceOf(root, page, b.column, b.row),
                     at_c = PlaceOf(root, page, c.column, c.row);
    const double area = (b.column - a.column) * (c.row - a.row) - (c.column - a.column) * (b.row - a.row);
    const std::function<void(Quadcode)> visit = [&](Quadcode node) {
      if (pages.has(node.Child(0))) {
        for (const int which : node.Children()) visit(node.Child(which));
        return;
      }
      const double post_width = static_cast<double>(node.PostSpacingEast()) / root.PostSpacingEast();
      const double post_height = static_cast<double>(node.PostSpacingNorth()) / root.PostSpacingNorth();
      const double west = static_cast<double>(node.SouthWest().x - root.SouthWest().x) / root.PostSpacingEast();
      const double south = static_cast<double>(node.SouthWest().y - root.SouthWest().y) / root.PostSpacingNorth();
      for (int row = 0; row < kPosts; ++row) {
        for (int column = 0; column < kPosts; ++column) {
          const double x = west + column * post_width - a.column, y = south + row * post_height - a.row;
          const double u = (x * (c.row - a.row) - (c.column - a.column) * y) / area;
          const double v = ((b.column - a.column) * y - x * (b.row - a.row)) / area;
          if (u < 0 || v < 0 || u + v > 1) continue;
          greatest = std::max(greatest, glm::distance(PlaceOf(node, pages.at(node), column, row),
                                                      (1 - u - v) * at_a + u * at_b + v * at_c));
        }
      }
    };
    visit(root);
  };
  for (const Post apex : {split.apex_a, split.apex_b}) {
    if (apex.inside()) add_triangle(apex, split.end_a, split.end_b);
  }
  return greatest;
}

// One post in two hundred, of every level.
std::vector<Post> PostsToTry() {
  std::vector<Post> posts;
  for (int level = 0; level < kBisectionLevels; ++level) {
    int number = 0;
    ForEachPost(level, [&](Post post) {
      if (number++ % 199 == 0) posts.push_back(post);
    });
  }
  return posts;
}

bool AtPole(Quadcode node) {
  return node.touches_north_pole() || node.touches_south_pole();
}

const std::vector<Quadcode>& NodesToTry() {
  static const std::vector<Quadcode> kNodes{
      Quadcode::Root(20),  // then one anywhere, a pole and 180 W, 180 E and a pole
      Quadcode::Containing(46, 8, 8), Quadcode::FromColumnRow(9, 0, 0),
      Quadcode::FromColumnRow(6, -1, (kTreeRows << 6) - 1), Quadcode::FromColumnRow(12, -1, 9000)};
  return kNodes;
}

TEST(DeltasFromChildren, WhereTheChildrenAreTheFinestDeltaValuesAreTheGreatestDistances) {
  for (const Quadcode node : NodesToTry()) {
    const Pages pages(node, 1);
    const std::vector<float> deltas = RestoreDeltas(pages.at(node).deltas);
    const double rounding_m = node.level() == 0 ? 1.0 : 2e-3;
    for (const Post post : PostsToTry()) {
      const double distance = GreatestDistance(pages, node, post);
      const auto delta = static_cast<double>(deltas[static_cast<size_t>(post.index())]);
      EXPECT_GE(delta, distance - rounding_m) << node.ToString() << " " << post.column << " " << post.row;
      // Of a wide child's surface more than its posts counts (HalveWide); how much more the next test says.
      if (AtPole(node)) continue;
      // A root spans too much of the Earth to be taken for a paraboloid.
      const double looser = node.is_root() ? 1.3 : 1.02;
      EXPECT_LE(delta, distance * std::exp2(1.0 / kDeltaStepsPerOctave) * looser + 2 * rounding_m)
          << node.ToString() << " " << post.column << " " << post.row;
    }
  }
}

TEST(DeltasFromChildren, WhatIsFinerThanTheChildrenIsInTheDeltaValues) {
  for (const Quadcode node : NodesToTry()) {
    const Pages pages(node, 3);
    const std::vector<float> deltas = RestoreDeltas(pages.at(node).deltas);
    const double rounding_m = node.level() == 0 ? 1.0 : 2e-3;
    double ratios = 0;
    int posts = 0;
    for (const Post post : PostsToTry()) {
      const double distance = GreatestDistance(pages, node, post);
      const auto delta = static_cast<double>(deltas[static_cast<size_t>(post.index())]);
      EXPECT_GE(delta, distance - rounding_m) << node.ToString() << " " << post.column << " " << post.row;
      ratios += delta / distance;
      ++posts;
    }
    // What a wide child may add (HalveWide) is half of all that is left here.
    EXPECT_LT(ratios / posts, AtPole(node) ? 1.6 : 1.25) << node.ToString() << ": the bound is far from what it bounds";
  }
}

TEST(DeltasFromChildren, StoredDeltaValuesPromiseNoLessAndLittleMore) {
  std::vector<float> deltas(kVerticesPerPage);
  for (size_t i = 0; i < deltas.size(); ++i) deltas[i] = 12'345.0F * std::exp2(-static_cast<float>(i) / 900.0F);
  const std::vector<float> restored = RestoreDeltas(StoreDeltas(deltas));
  ASSERT_EQ(restored.size(), deltas.size());
  for (size_t i = 0; i < deltas.size(); ++i) {
    EXPECT_GE(restored[i], deltas[i]);
    EXPECT_LE(restored[i], deltas[i] * 1.0595F);
  }
  // Nothing is less than the 255th step below the greatest.
  deltas[7] = 0;
  EXPECT_LT(RestoreDeltas(StoreDeltas(deltas))[7], 12'345.0F * 4.1e-7F);
}

}  // namespace
}  // namespace belvedere

#include "managers/surface_mesh.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace belvedere {
namespace {

using test::FlatPage;
using test::RandomCutNodes;
using test::RandomDeltas;

struct Surface {
  std::vector<std::unique_ptr<TerrainPage>> pages;
  std::vector<CutNode> cut;
  std::unique_ptr<DisplayList> built = std::make_unique<DisplayList>();
  DisplayList& list = *built;
  MeshStatistics statistics;
};

Surface MakeSurface(std::mt19937& random, const std::vector<Quadcode>& nodes, const glm::dvec3& eye_ecef,
                    double error_px) {
  Surface surface;
  for (const Quadcode node : nodes) {
    surface.pages.push_back(FlatPage(node, RandomDeltas(random)));
    CutNode drawn;
    drawn.node = node;
    drawn.page = surface.pages.back().get();
    drawn.error_scale = 700;
    surface.cut.push_back(drawn);
  }
  Sight sight;
  sight.eye_ecef = eye_ecef;
  sight.forward_ecef = -glm::normalize(eye_ecef);
  sight.cos_corner = 0.7;
  SurfaceState state;
  state.morph.Begin(0, true);
  surface.statistics = BuildSurface(surface.cut, sight, error_px, state, surface.list);
  return surface;
}

// Position on the grid of a vertex; all of a pole is one position, and 180 E is 180 W.
GridPoint PositionOf(const Surface& surface, uint32_t vertex) {
  const ListVertex& v = (*surface.list.vertices)[vertex];
  const Quadcode node = surface.list.terrain_draws[v.draw()].node;
  GridPoint point{node.SouthWest().x + v.post() % kPosts * node.PostSpacingEast(),
                  node.SouthWest().y + v.post() / kPosts * node.PostSpacingNorth()};
  if (point.y == 0 || point.y == kGridNorthPole) point.x = 0;
  return point;
}

// The whole Earth is a closed surface: every edge must have exactly one triangle on either side.
void ExpectClosed(const Surface& surface) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  std::set<uint32_t> vertices;
  for (size_t t = 0; t + 2 < surface.list.indices.size(); t += 3) {
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint32_t from = surface.list.indices[t + corner];
      const uint32_t to = surface.list.indices[t + (corner + 1) % 3];
      ASSERT_NE(from, to);
      ++edges[{from, to}];
      vertices.insert(from);
    }
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << "edge " << edge.first << "-" << edge.second << " is run through twice the same way";
    ASSERT_TRUE(edges.contains({edge.second, edge.first}))
        << "edge " << edge.first << "-" << edge.second << " has one side only";
  }
  const auto v = static_cast<int64_t>(vertices.size());
  const auto e = static_cast<int64_t>(edges.size() / 2);
  const auto f = static_cast<int64_t>(surface.list.indices.size() / 3);
  EXPECT_EQ(v - e + f, 2) << "a sphere's Euler number";
  std::set<GridPoint> positions;
  for (const uint32_t vertex : vertices) {
    EXPECT_TRUE(positions.insert(PositionOf(surface, vertex)).second)
        << "two vertices at one place: a crack could hide";
  }
}

TEST(SurfaceMesh, RootsAloneAreClosed) {
  std::mt19937 random(1);
  ExpectClosed(MakeSurface(random, RandomCutNodes(random, 0, 0), ToEcef({37, -118, 1e7}), 2.0));
}

TEST(SurfaceMesh, RandomCutsAreClosedFromAnywhere) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> latitude(-90, 90);
  std::uniform_real_distribution<double> longitude(-180, 180);
  std::uniform_real_distribution<double> exponent(1, 7);
  for (int round = 0; round < 12; ++round) {
    const std::vector<Quadcode> nodes = RandomCutNodes(random, 8 + 2 * round, 3 + round);
    const glm::dvec3 eye = ToEcef({latitude(random), longitude(random), std::pow(10.0, exponent(random))});
    const Surface surface = MakeSurface(random, nodes, eye, 64.0);
    ASSERT_GT(surface.statistics.triangles, 64U);
    ExpectClosed(surface);
    if (testing::Test::HasFailure()) return;
  }
}

// Splits a quadnode, or puts one in the place of its children.
void ChangeCut(std::mt19937& random, std::vector<Quadcode>& nodes) {
  constexpr int kDeepest = 9;
  const Quadcode chosen = nodes[std::uniform_int_distribution<size_t>(0, nodes.size() - 1)(random)];
  if (random() % 2 == 0 && chosen.level() < kDeepest) {
    std::erase(nodes, chosen);
    for (const int which : chosen.Children()) nodes.push_back(chosen.Child(which));
    return;
  }
  if (chosen.is_root()) return;
  const Quadcode parent = chosen.Parent();
  const auto is_child = [&](Quadcode node) { return !node.is_root() && node.Parent() == parent; };
  if (std::count_if(nodes.begin(), nodes.end(), is_child) != 4) return;
  std::erase_if(nodes, is_child);
  nodes.push_back(parent);
}

// Lists take over from one another what did not change, whatever the order in which quadnodes come.
TEST(SurfaceMesh, StaysClosedFromListToList) {
  std::mt19937 random(11);
  std::vector<Quadcode> nodes = RandomCutNodes(random, 40, 9);
  std::map<Quadcode, std::unique_ptr<TerrainPage>> pages;
  SurfaceState state;
  Sight sight;
  sight.cos_corner = 0.7;
  uint64_t kept = 0;
  for (int number = 0; number < 40; ++number) {
    for (int change = 0; change < number % 4; ++change) ChangeCut(random, nodes);
    std::shuffle(nodes.begin(), nodes.end(), random);
    sight.eye_ecef = ToEcef({37 + 0.05 * (number / 5), -118, 4e6});
    sight.forward_ecef = -glm::normalize(sight.eye_ecef);
    Surface surface;
    for (const Quadcode node : nodes) {
      auto& page = pages[node];
      if (!page) page = FlatPage(node, RandomDeltas(random));
      CutNode drawn;
      drawn.node = node;
      drawn.page = page.get();
      drawn.error_scale = 700;
      drawn.nearest_depth_m = std::max(1.0, glm::distance(page->center_ecef, sight.eye_ecef) - page->radius_m);
      surface.cut.push_back(drawn);
    }
    const uint64_t chosen = state.kept.chosen();
    state.morph.Begin(number / 30.0, false);
    surface.statistics = BuildSurface(surface.cut, sight, 32.0, state, surface.list);
    kept += nodes.size() - (state.kept.chosen() - chosen);
    ExpectClosed(surface);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(kept, 20 * nodes.size()) << "nothing would be taken over";
  EXPECT_LT(kept, 39 * nodes.size()) << "nothing would have changed";
}

TEST(SurfaceMesh, ClosedWhereAQuadnodeLiesBesideOnesManyLevelsFiner) {
  // The neighbourhood of a corner of the coarse quadnode, split to level 12, across a tree border, 180 E and a pole.
  for (const auto& [latitude, longitude] :
       {std::pair{0.0, 0.0}, {45.0, 180.0}, {89.999, -180.0}, {-89.999, 45.0}, {22.5, -157.5}}) {
    std::mt19937 random(3);
    std::vector<Quadcode> nodes;
    for (int tree = 0; tree < kTrees; ++tree) nodes.push_back(Quadcode::Root(tree));
    for (int level = 0; level < 12; ++level) {
      const Quadcode deep = Quadcode::Containing(latitude, longitude, level);
      const auto found = std::find(nodes.begin(), nodes.end(), deep);
      ASSERT_NE(found, nodes.end());
      nodes.erase(found);
      for (const int which : deep.Children()) nodes.push_back(deep.Child(which));
    }
    ExpectClosed(MakeSurface(random, nodes, ToEcef({latitude, longitude, 5000}), 4.0));
  }
}

TEST(SurfaceMesh, EveryTriangleFacesOutwards) {
  std::mt19937 random(4);
  const Surface surface = MakeSurface(random, RandomCutNodes(random, 20, 8), ToEcef({10, 20, 1e6}), 16.0);
  const auto position = [&](uint32_t vertex) {
    const ListVertex& v = (*surface.list.vertices)[vertex];
    return surface.list.frames[surface.list.terrain_draws[v.draw()].frame].ToEcef({v.x, v.y, v.z});
  };
  for (size_t t = 0; t < surface.list.indices.size(); t += 3) {
    const glm::dvec3 a = position(surface.list.indices[t]);
    const glm::dvec3 b = position(surface.list.indices[t + 1]);
    const glm::dvec3 c = position(surface.list.indices[t + 2]);
    // Slivers at a pole stand upright: no area seen from above, but for rounding.
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    EXPECT_GE(glm::dot(normal, a + b + c), -1e-6 * glm::length(normal) * glm::length(a + b + c));
  }
}

TEST(SurfaceMesh, ATighterBoundDrawsMore) {
  std::mt19937 random(6);
  const std::vector<Quadcode> nodes = RandomCutNodes(random, 6, 4);
  std::mt19937 same_pages(7);
  const uint32_t loose = MakeSurface(same_pages, nodes, ToEcef({30, 40, 2e6}), 4.0).statistics.triangles;
  same_pages.seed(7);
  const uint32_t tight = MakeSurface(same_pages, nodes, ToEcef({30, 40, 2e6}), 0.5).statistics.triangles;
  EXPECT_GT(tight, loose);
}

TEST(SurfaceMesh, TheFarSideIsRoundThoughNobodyLooksAtIt) {
  const auto page = FlatPage(Quadcode::Root(0), std::vector<float>(kVerticesPerPage, 20'000.0F));
  CutNode hidden;
  hidden.node = Quadcode::Root(0);
  hidden.page = page.get();
  hidden.error_scale = 0;  // behind the horizon
  DisplayList list;
  const std::vector<CutNode> cut{hidden};
  SurfaceState state;
  EXPECT_EQ(BuildSurface(cut, Sight{}, 2.0, state, list).triangles,
            2U * kCells * kCells - kCells);  // less one a column at the pole
}

TEST(SurfaceMesh, ReportsAnErrorUnderTheBound) {
  std::mt19937 random(8);
  const Surface surface = MakeSurface(random, RandomCutNodes(random, 6, 4), ToEcef({30, 40, 2e6}), 16.0);
  EXPECT_GT(surface.statistics.achieved_error_px, 0.0);
  EXPECT_LE(surface.statistics.achieved_error_px, 16.0 * 1.0001);
}

}  // namespace
}  // namespace belvedere

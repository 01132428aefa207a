// The surface as it is drawn between lists, at places of no special kind: it does not jump, and it arrives.
#include "managers/surface_morph.h"

#include "managers/surface_mesh.h"
#include "render/drawn_ground.h"
#include "runtime/earth/bisection.h"
#include "servers/terrain_builder.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <random>

namespace belvedere {
namespace {

constexpr double kLatitude = 36.5, kLongitude = -118.3;
constexpr double kBound_px = 1.0;
constexpr double kPixelsPerRadian = 700;
constexpr int kDeepest = 7;

// Ridges 5 km apart, which coarse levels miss.
double Ridges(GridPoint point) {
  return WavyHeight(point) + 300 * std::sin(point.latitude_deg() * 110) * std::cos(point.longitude_deg() * 90);
}

class SurfaceMorphTest : public testing::Test {
 protected:
  const TerrainPage* Page(Quadcode node) {
    Built& built = pages_[node];
    if (!built.page) {
      built.heights = MakeElevation(node, Ridges);
      // The errors that finer pages add, as they would be over waves that halve with the spacing of posts.
      built.heights->error_m = node.level() < kDeepest ? static_cast<float>(std::ldexp(900.0, -node.level())) : 0.0F;
      built.heights->block_errors_m.fill(built.heights->error_m);
      TerrainInput input{.node = node, .heights = built.heights.get(), .heights_node = node};
      input.finer_exists = node.level() < kDeepest;
      built.page = BuildTerrain(input);
    }
    return built.page.get();
  }

  // A cut of the whole Earth with quadnodes of the level around the place.
  std::vector<CutNode> CutTo(int level, double height_m) {
    std::vector<Quadcode> nodes;
    for (int tree = 0; tree < kTrees; ++tree) nodes.push_back(Quadcode::Root(tree));
    for (int l = 0; l < level; ++l) {
      const Quadcode deep = Quadcode::Containing(kLatitude, kLongitude, l);
      nodes.erase(std::find(nodes.begin(), nodes.end(), deep));
      for (const int which : deep.Children()) nodes.push_back(deep.Child(which));
    }
    eye_ecef_ = ToEcef({kLatitude, kLongitude, height_m});
    std::vector<CutNode> cut;
    for (const Quadcode node : nodes) {
      CutNode drawn;
      drawn.node = node;
      drawn.page = Page(node);
      drawn.error_scale = kPixelsPerRadian;
      drawn.nearest_depth_m =
          std::max(1000.0, glm::distance(eye_ecef_, drawn.page->center_ecef) - drawn.page->radius_m);
      drawn.visible = glm::distance(eye_ecef_, drawn.page->center_ecef) - drawn.page->radius_m < 2e6;
      cut.push_back(drawn);
    }
    return cut;
  }

  std::unique_ptr<DisplayList> List(const std::vector<CutNode>& cut, double now_s, bool jump = false) {
    auto list = std::make_unique<DisplayList>();
    Sight sight{eye_ecef_, -glm::normalize(eye_ecef_), 0.7, true};
    sight.inwards_ecef[0] = inward_ecef_;
    state_.morph.Begin(now_s, jump);
    list->time_s = now_s;
    statistics_ = BuildSurface(cut, sight, kBound_px, state_, *list);
    return list;
  }

  // The greatest difference between what two lists draw at that time, in pixels.
  double Difference_px(const DisplayList& a, const DisplayList& b, double now_s) const {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> within(-3.0, 3.0);
    double most_px = 0;
    for (int i = 0; i < 60; ++i) {
      const Geodetic place{kLatitude + within(random), kLongitude + within(random), 0};
      const auto height_a = DrawnGroundAt(a, place, now_s - a.time_s);
      const auto height_b = DrawnGroundAt(b, place, now_s - b.time_s);
      const double distance_m = glm::distance(eye_ecef_, ToEcef({place.latitude_deg, place.longitude_deg, 1500}));
      most_px = std::max(most_px, std::abs(height_a.value() - height_b.value()) * kPixelsPerRadian / distance_m);
    }
    return most_px;
  }

  struct Built {
    std::unique_ptr<ElevationPage> heights;
    std::unique_ptr<TerrainPage> page;
  };
  std::map<Quadcode, Built> pages_;
  glm::dvec3 eye_ecef_{};
  glm::dvec3 inward_ecef_{};  // normal of the picture's one side; zero: it has none
  SurfaceState state_;
  MeshStatistics statistics_;
};

TEST_F(SurfaceMorphTest, AFinerSurfaceStartsWhereTheCoarserOneWas) {
  const auto coarse = List(CutTo(3, 60'000), 0, true);
  const auto finer = List(CutTo(6, 50'000), 1);
  EXPECT_LT(Difference_px(*coarse, *finer, 1.0), 0.3);
  EXPECT_GT(Difference_px(*coarse, *finer, 3.0), 1.0) << "they differ once the finer one has arrived";
}

// The picture's western side turns down to the meridian under the eye. The strip beyond it is drawn finely now, for it
// may come into the picture soon, and what rises there is seen by nobody.
TEST_F(SurfaceMorphTest, BesideThePictureItIsThereAtOnce) {
  const glm::dvec3 up = glm::normalize(ToEcef({kLatitude, kLongitude, 0}));
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), up));
  const std::vector<CutNode> cut = CutTo(6, 50'000);
  inward_ecef_ = glm::normalize(east + 0.5 * up);
  List(cut, 0, true);
  inward_ecef_ = east;
  const auto turned = List(cut, 1);
  double most_hidden_m = 0, most_seen_m = 0;
  int hidden = 0;
  for (const ListVertex& vertex : *turned->vertices) {
    const TerrainDraw& draw = turned->terrain_draws[vertex.draw()];
    const auto post = static_cast<int>(vertex.post());
    const int column = post % kPosts, row = post / kPosts;
    if (column % kCells == 0 || row % kCells == 0) continue;
    const TerrainPage& page = *Page(draw.node);
    const glm::dvec3 place = turned->frames[draw.frame].ToEcef({vertex.x, vertex.y, vertex.z});
    const double inside_m = glm::dot(place - eye_ecef_, east);
    const double spread_m = page.spread_m[static_cast<size_t>(LevelOf({column, row}))];
    const bool in_strip = inside_m < -1.01 * spread_m && inside_m > -kBesideGuard * glm::distance(place, eye_ecef_);
    if (in_strip) ++hidden;
    if (in_strip) most_hidden_m = std::max(most_hidden_m, std::abs(static_cast<double>(vertex.rise_m)));
    if (inside_m > 0) most_seen_m = std::max(most_seen_m, std::abs(static_cast<double>(vertex.rise_m)));
  }
  EXPECT_GT(hidden, 50);
  EXPECT_EQ(most_hidden_m, 0);
  EXPECT_GT(most_seen_m, 1);
}

TEST_F(SurfaceMorphTest, AndArrivesWhereItBelongs) {
  List(CutTo(3, 60'000), 0, true);
  const std::vector<CutNode> cut = CutTo(6, 50'000);
  const auto finer = List(cut, 1);
  EXPECT_GE(statistics_.rises_until_s, 1 + SurfaceMorph::kLeast_s);
  EXPECT_LE(statistics_.rises_until_s, 1 + SurfaceMorph::kMost_s);
  SurfaceState other;
  std::swap(other, state_);
  const auto at_once = List(cut, 1, true);
  EXPECT_EQ(statistics_.rises_until_s, 0);
  EXPECT_LT(Difference_px(*finer, *at_once, 1 + SurfaceMorph::kMost_s), 1e-3);
}

TEST_F(SurfaceMorphTest, ACoarserSurfaceStartsThereToo) {
  const auto fine = List(CutTo(6, 50'000), 0, true);
  const auto coarser = List(CutTo(5, 300'000), 1);
  // Posts that are left out at once make less than a pixel.
  EXPECT_LT(Difference_px(*fine, *coarser, 1.0), 1.0);
}

// Lists that come while vertices are on their way take over from one another.
TEST_F(SurfaceMorphTest, TheWayGoesOnFromListToList) {
  List(CutTo(3, 60'000), 0, true);
  const auto first = List(CutTo(5, 50'000), 1);
  const auto second = List(CutTo(6, 50'000), 1.1);
  EXPECT_LT(Difference_px(*first, *second, 1.1), 0.3);
  const auto third = List(CutTo(6, 50'000), 1.2);
  EXPECT_LT(Difference_px(*second, *third, 1.2), 1e-2);
  EXPECT_LT(Difference_px(*second, *third, 1.25), 0.2);
}

// A descent, 60 frames and 30 lists a second: nothing moves by more than a pixel from one frame to the next.
TEST_F(SurfaceMorphTest, NoPointMovesMoreThanAPixelAFrame) {
  double height_m = 120'000;
  auto drawn = List(CutTo(3, height_m), 0, true);
  double now_s = 0;
  for (int frame = 1; frame <= 60; ++frame) {
    const double before_s = now_s;
    now_s = frame / 60.0;
    auto next = frame % 2 == 0 ? List(CutTo(3 + frame / 16, height_m *= 0.98), now_s) : nullptr;
    const DisplayList& shown = next ? *next : *drawn;
    // What the two frames show, each at its own time.
    std::mt19937 random(static_cast<uint32_t>(frame));
    std::uniform_real_distribution<double> within(-2.0, 2.0);
    for (int i = 0; i < 25; ++i) {
      const Geodetic place{kLatitude + within(random), kLongitude + within(random), 0};
      const double before_m = DrawnGroundAt(*drawn, place, before_s - drawn->time_s).value();
      const double now_m = DrawnGroundAt(shown, place, now_s - shown.time_s).value();
      const double distance_m = glm::distance(eye_ecef_, ToEcef({place.latitude_deg, place.longitude_deg, 1500}));
      ASSERT_LT(std::abs(now_m - before_m) * kPixelsPerRadian / distance_m, 1.0) << "frame " << frame;
    }
    if (next) drawn = std::move(next);
  }
}

TEST_F(SurfaceMorphTest, WhereTheEyeHasJumpedSoDoesTheSurface) {
  List(CutTo(3, 60'000), 0, true);
  const auto finer = List(CutTo(6, 50'000), 1, true);
  EXPECT_EQ(statistics_.rises_until_s, 0);
  EXPECT_TRUE(std::all_of(finer->vertices->begin(), finer->vertices->end(),
                          [](const ListVertex& vertex) { return vertex.rise_m == 0; }));
}

}  // namespace
}  // namespace belvedere

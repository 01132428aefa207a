#include "preproc/plan.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace belvedere {
namespace {

TEST(Plan, TheFinestLevelIsTheCoarsestThatKeepsUpWithTheSource) {
  for (const LayerKind kind : {LayerKind::kElevation, LayerKind::kImagery}) {
    const double root_deg = kTreeDegrees / (kind == LayerKind::kElevation ? kCells : kImageInner);
    EXPECT_EQ(FinestLevel(10, kind), 0);
    EXPECT_EQ(FinestLevel(root_deg, kind), 0);
    for (int level = 1; level < kMaxLevel; ++level) {
      const double spacing_deg = std::ldexp(root_deg, -level);
      EXPECT_EQ(FinestLevel(spacing_deg, kind), level);
      EXPECT_EQ(FinestLevel(spacing_deg * 1.1, kind), level);
      EXPECT_EQ(FinestLevel(spacing_deg * 0.9, kind), level + 1);
    }
    EXPECT_EQ(FinestLevel(1e-12, kind), kMaxLevel);
  }
}

TEST(Plan, LevelZeroIsWholeAndFinerNodesFollowTheSource) {
  EXPECT_EQ(CountNodes({}), kTrees);
  // Within one quadnode of every level: three siblings of each level come with the one that holds it.
  const std::vector<PlannedSource> inside = {{{10.01, 50.01, 10.02, 50.02}, 5}};
  EXPECT_EQ(CountNodes(inside), kTrees + 3 + 4 * 4);  // three of a root at a pole
  const std::vector<PlannedSource> world = {{{-180, -90, 180, 90}, 3}};
  // Half of the trees have a pole: of level n they have 3 * 4^(n-1) quadnodes less those that are twice as wide.
  EXPECT_EQ(CountNodes(world), 16 * (1 + 4 + 16 + 64) + 16 * (1 + 3 + (2 * 4 + 2) + (2 * 16 + 4 + 2)));
  EXPECT_EQ(SourceLevel(inside, Quadcode::Containing(50.015, 10.015, 3)), 5);
  EXPECT_EQ(SourceLevel(inside, Quadcode::Containing(-50, 10, 3)), 0);
}

TEST(Boxes, AreWidenedByMetres) {
  const GeoBox wide = Widened({10, 59, 11, 60}, 1000);
  const glm::dvec2 metres = MetresPerDegree(60);
  EXPECT_LE(wide.west_deg, 10 - 1000 / metres.x);
  EXPECT_NEAR(wide.west_deg, 10 - 1000 / metres.x, 2e-4) << "and not much more";
  EXPECT_LE(wide.south_deg, 59 - 1000 / metres.y);
  EXPECT_GE(wide.north_deg, 60 + 1000 / metres.y);
  EXPECT_NEAR(wide.north_deg, 60 + 1000 / metres.y, 2e-4);
  const GeoBox pole = Widened({10, 89.999, 10, 89.999}, 1000);
  EXPECT_GE(pole.east_deg - pole.west_deg, 360) << "all around";
}

TEST(Plan, BoxesOverlapWhateverTheirTurn) {
  const GeoBox seam{170, -10, 190, 10};
  EXPECT_TRUE(Overlap(seam, {-180, 0, -175, 5}));
  EXPECT_TRUE(Overlap(seam, {175, 0, 180, 5}));
  EXPECT_TRUE(Overlap({-190, -10, -170, 10}, {175, 0, 180, 5}));
  EXPECT_TRUE(Overlap({0, -90, 360, 90}, {-90, 0, -45, 45}));
  EXPECT_FALSE(Overlap(seam, {0, 0, 45, 45}));
  EXPECT_FALSE(Overlap({0, 0, 45, 45}, {45, 0, 90, 45})) << "a border is no overlap";
  EXPECT_FALSE(Overlap({0, 0, 45, 45}, {0, 45, 45, 90}));
}

TEST(Plan, ByResolutionTheFinestIsLastAndTiesStayAsTheyWere) {
  const auto places = [](const std::vector<PlannedSource>& sources) { return PlacesByResolution(sources); };
  const PlannedSource coarse{{}, 2, 0.1, false}, fine{{}, 5, 0.01, false}, as_fine{{}, 5, 0.0100001, false};
  const PlannedSource finest{{}, 8, 0.001, false}, timed{{}, 3, 0.05, true};
  EXPECT_EQ(places({finest, fine, coarse}), (std::vector<size_t>{2, 1, 0}));
  EXPECT_EQ(places({coarse, fine, finest}), (std::vector<size_t>{0, 1, 2}));
  EXPECT_EQ(places({fine, coarse, as_fine, fine}), (std::vector<size_t>{1, 0, 2, 3}));
  EXPECT_EQ(places({as_fine, fine, coarse}), (std::vector<size_t>{2, 0, 1}));
  EXPECT_EQ(places({timed, finest, coarse}), (std::vector<size_t>{2, 1, 0}))
      << "what has a time lies over what has none";
}

}  // namespace
}  // namespace belvedere

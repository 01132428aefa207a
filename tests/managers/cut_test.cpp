#include "managers/cut.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace belvedere {
namespace {

constexpr DataType kTerrain = 0;
constexpr DataType kImagery = 1;
constexpr DataType kNextImagery = 2;

// An Earth whose pages all exist down to a level; which are on the GPU is the test's to say.
class FakePages final : public PageAccess {
 public:
  const TerrainPage* Terrain(Quadcode node) override {
    if (missing.contains(node)) return nullptr;
    auto& page = pages_[node];
    if (!page) page = Make(node);
    return page.get();
  }
  std::optional<int> Slot(const PageKey& key) override {
    if (missing_images.contains(key.node)) return std::nullopt;
    if (key.type == kNextImagery && !next_images.contains(key.node)) return std::nullopt;
    return 1000 + key.node.level();
  }
  bool Want(const PageKey& key, float priority) override {
    wanted[key] = priority;
    return !failed.contains(key.node);
  }

  std::set<Quadcode> missing, missing_images, failed;
  std::set<Quadcode> next_images;  // of the next step, those that are there
  std::map<PageKey, float> wanted;

 private:
  static constexpr float kHighest_m = 1000;

  static std::unique_ptr<TerrainPage> Make(Quadcode node) {
    auto page = std::make_unique<TerrainPage>();
    page->node = node;
    const GeoBox box = node.Box();
    page->center_ecef = ToEcef({0.5 * (box.south_deg + box.north_deg), 0.5 * (box.west_deg + box.east_deg), 0.0});
    for (const double latitude : {box.south_deg, box.north_deg}) {
      for (const double longitude : {box.west_deg, box.east_deg}) {
        for (const double height_m : {0.0, double{kHighest_m}}) {
          const double away_m = glm::distance(page->center_ecef, ToEcef({latitude, longitude, height_m}));
          page->radius_m = std::max(page->radius_m, away_m);
        }
      }
    }
    page->max_height_m = kHighest_m;
    page->error_m = static_cast<float>(std::ldexp(3000.0, -node.level()));
    return page;
  }
  std::map<Quadcode, std::unique_ptr<TerrainPage>> pages_;
};

class CutTest : public testing::Test {
 protected:
  CutTest() {
    layers_.Add({"terrain", PageKind::kTerrain, 0, 12, [](Quadcode node) { return node.level() <= 12; }});
    layers_.Add({"imagery", PageKind::kColour, 0, 5, [](Quadcode node) { return node.level() <= 5; }});
    layers_.Add({"next imagery", PageKind::kColour, 0, 5, [](Quadcode node) { return node.level() <= 5; }});
    LookFrom(37, -118, 20'000, -30);
  }
  void LookFrom(double latitude, double longitude, double height, double pitch_deg) {
    view_.eye_ecef = ToEcef({latitude, longitude, height});
    view_.ecef_from_camera = CameraAxes(latitude, longitude, {}, Radians::FromDegrees(pitch_deg), {});
    view_.image_layers = {{kImagery}};
  }
  Cut Select(const CutLimits& limits = {}) {
    return SelectCut(view_, MatricesOf(view_, 0, 1000), layers_, kTerrain, limits, pages_, before_);
  }
  static int Deepest(const Cut& cut) {
    int deepest = 0;
    for (const CutNode& node : cut.nodes) deepest = std::max(deepest, node.node.level());
    return deepest;
  }

  LayerTable layers_;
  FakePages pages_;
  ViewParameters view_;
  std::vector<DataType> before_;
};

// Every cut covers the Earth exactly once.
void ExpectCover(const Cut& cut) {
  double area = 0;
  std::set<Quadcode> nodes;
  for (const CutNode& node : cut.nodes) {
    area += node.node.WidthDegrees() * node.node.HeightDegrees();
    EXPECT_TRUE(nodes.insert(node.node).second);
    for (int level = 0; level < node.node.level(); ++level) EXPECT_FALSE(nodes.contains(node.node.Ancestor(level)));
  }
  EXPECT_DOUBLE_EQ(area, 360.0 * 180.0);
}

TEST_F(CutTest, CoversTheEarthOnce) {
  ExpectCover(Select());
  LookFrom(-89.99, 100, 3000, -10);
  ExpectCover(Select());
  LookFrom(0, 180, 1e7, -90);
  ExpectCover(Select());
}

TEST_F(CutTest, KeepsTheBoundInViewWhenAllPagesAreThere) {
  const Cut cut = Select();
  EXPECT_FALSE(cut.behind);
  EXPECT_FALSE(cut.waiting);
  EXPECT_GT(Deepest(cut), 5);
  for (const CutNode& node : cut.nodes) {
    if (!node.visible) continue;
    EXPECT_TRUE(node.finest || node.node.level() == 12) << node.node.ToString();
  }
}

// The mean side of a texel on the screen, pixels, at a place on the ellipsoid; 0 where it is not in the picture.
double TexelSide_px(const ViewParameters& view, const ViewMatrices& matrices, double latitude, double longitude,
                    int level) {
  const double texel_deg = std::ldexp(kTreeDegrees, -level) / kImageInner;
  const auto on_screen = [&](double north, double east) {
    const glm::dvec3 ecef = ToEcef({latitude + north * texel_deg, longitude + east * texel_deg, 0.0});
    const glm::dvec3 camera = (ecef - matrices.eye_ecef) * view.ecef_from_camera;
    return camera.z < 0 ? matrices.pixels_per_radian * glm::dvec2(camera) / -camera.z : glm::dvec2(1e9);
  };
  const glm::dvec2 here = on_screen(0, 0);
  if (std::abs(here.x) > 0.5 * view.width_px || std::abs(here.y) > 0.5 * view.height_px) return 0;
  const glm::dvec2 north = on_screen(0.01, 0) - here, east = on_screen(0, 0.01) - here;
  return std::sqrt(std::abs(north.x * east.y - north.y * east.x)) / 0.01;
}

TEST_F(CutTest, TexelsKeepTheirBoundAtAnySlant) {
  view_.error_px = 1e9;  // images alone ask for quadnodes
  int looked_at = 0;
  for (const double height_m : {20e3, 200e3, 2000e3}) {
    for (const double pitch_deg : {-90.0, -50.0, -25.0, -8.0}) {
      LookFrom(37, -118, height_m, pitch_deg);
      const ViewMatrices matrices = MatricesOf(view_, 0, height_m);
      const Cut cut = SelectCut(view_, matrices, layers_, kTerrain, {}, pages_, before_);
      double greatest_px = 0;
      for (const CutNode& drawn : cut.nodes) {
        if (!drawn.visible || drawn.images[0].slot < 0) continue;
        const int level = drawn.images[0].source.level();
        if (level == 5) continue;  // there are no finer ones
        const GeoBox box = drawn.node.Box();
        for (int i = 0; i < 100; ++i) {
          const double latitude = box.south_deg + i / 10 * 0.111 * drawn.node.HeightDegrees();
          const double longitude = box.west_deg + i % 10 * 0.111 * drawn.node.WidthDegrees();
          if (matrices.horizon.Hides({ToEcef({latitude, longitude, 0.0}), 1.0})) continue;
          greatest_px = std::max(greatest_px, TexelSide_px(view_, matrices, latitude, longitude, level));
        }
      }
      EXPECT_LE(greatest_px, view_.texel_px * 1.01) << height_m << " m up, pitch " << pitch_deg;
      if (greatest_px == 0) continue;  // all of the finest level
      EXPECT_GT(greatest_px, view_.texel_px * 0.2) << height_m << " m up, pitch " << pitch_deg;
      ++looked_at;
    }
  }
  EXPECT_GE(looked_at, 8);
}

TEST_F(CutTest, ATighterBoundRefinesMore) {
  view_.texel_px = 1e9;
  view_.error_px = 4;
  const size_t loose = Select().nodes.size();
  view_.error_px = 1;
  EXPECT_GT(Select().nodes.size(), loose);
}

TEST_F(CutTest, AMissingChildIsWantedAndItsParentDrawnInstead) {
  const Cut whole = Select();
  const auto deep = std::find_if(whole.nodes.begin(), whole.nodes.end(),
                                 [](const CutNode& node) { return node.visible && node.node.level() >= 5; });
  ASSERT_NE(deep, whole.nodes.end());
  pages_.missing.insert(deep->node);
  pages_.wanted.clear();
  const Cut cut = Select();
  ExpectCover(cut);
  EXPECT_TRUE(cut.behind);
  EXPECT_TRUE(cut.waiting);
  EXPECT_TRUE(pages_.wanted.contains({kTerrain, deep->node}));
  EXPECT_GT(pages_.wanted[(PageKey{kTerrain, deep->node})], 1.0F);
  EXPECT_TRUE(
      std::any_of(cut.nodes.begin(), cut.nodes.end(), [&](const CutNode& n) { return n.node == deep->node.Parent(); }));
}

TEST_F(CutTest, AFailedPageIsNotWaitedFor) {
  const Cut whole = Select();
  const auto deep = std::find_if(whole.nodes.begin(), whole.nodes.end(),
                                 [](const CutNode& node) { return node.visible && node.node.level() >= 5; });
  ASSERT_NE(deep, whole.nodes.end());
  pages_.missing.insert(deep->node);
  pages_.failed.insert(deep->node);
  const Cut cut = Select();
  EXPECT_FALSE(cut.waiting);
  EXPECT_FALSE(cut.behind);
}

TEST_F(CutTest, WithARootStillToComeThereIsNoEarthYet) {
  pages_.missing.insert(Quadcode::Root(5));
  const Cut cut = Select();
  EXPECT_TRUE(cut.nodes.empty());
  EXPECT_TRUE(cut.waiting);
  EXPECT_TRUE(pages_.wanted.contains({kTerrain, Quadcode::Root(5)}));
  pages_.failed.insert(Quadcode::Root(5));  // it never comes: the rest is shown
  EXPECT_FALSE(Select().nodes.empty());
}

TEST_F(CutTest, BehindTheHorizonAndBesideThePictureIsCoarser) {
  const Cut cut = Select();
  for (const CutNode& node : cut.nodes) {
    const double far_side = glm::dot(node.page->center_ecef, view_.eye_ecef);
    if (far_side < 0) {
      EXPECT_EQ(node.node.level(), 0) << node.node.ToString();
    }
  }
}

// Short of the latitude where rows grow wide, quadnodes are much narrower than their spheres.
TEST_F(CutTest, NarrowQuadnodesBesideThePictureAreCoarserAndNothingInItIs) {
  LookFrom(66.5, -76, 1500, -8);
  view_.ecef_from_camera = CameraAxes(66.5, -76, Radians::FromDegrees(110), Radians::FromDegrees(-8), {});
  const ViewMatrices matrices = MatricesOf(view_, 0, 1500);
  const Cut cut = SelectCut(view_, matrices, layers_, kTerrain, {}, pages_, before_);
  int fine = 0, by_sphere = 0;
  for (const CutNode& drawn : cut.nodes) {
    const BoundingSphere sphere{drawn.page->center_ecef, drawn.page->radius_m};
    by_sphere += drawn.node.level() >= 4 && !matrices.horizon.Hides(sphere) && !matrices.frustum.Hides(sphere) ? 1 : 0;
    fine += drawn.node.level() >= 4 && drawn.visible ? 1 : 0;
    if (drawn.visible) continue;
    const GeoBox box = drawn.node.Box();
    for (int i = 0; i < 32 * 32; ++i) {
      const double latitude = box.south_deg + (i / 32 + 0.5) / 32 * drawn.node.HeightDegrees();
      const double longitude = box.west_deg + (i % 32 + 0.5) / 32 * drawn.node.WidthDegrees();
      const BoundingSphere point{ToEcef({latitude, longitude, i % 2 == 0 ? 0.0 : 1000.0}), 1};
      ASSERT_TRUE(matrices.frustum.Hides(point) || matrices.horizon.Hides(point)) << drawn.node.ToString();
    }
  }
  EXPECT_GT(fine, 5);
  EXPECT_LT(fine, by_sphere);
}

TEST_F(CutTest, AnAncestorsImageServesThroughASubRectangle) {
  const Cut cut = Select();
  for (const CutNode& node : cut.nodes) {
    const ImageUse& image = node.images[0];
    ASSERT_GE(image.slot, 1000);
    const int levels = node.node.level() - (image.slot - 1000);
    const Quadcode source = node.node.Ancestor(image.slot - 1000);
    EXPECT_FLOAT_EQ(image.scale_v, std::ldexp(1.0F, -levels));
    EXPECT_FLOAT_EQ(image.scale_u, std::ldexp(1.0F, node.node.Doublings() - source.Doublings() - levels));
    EXPECT_FLOAT_EQ(image.offset_u,
                    static_cast<float>((node.node.Box().west_deg - source.Box().west_deg) / source.WidthDegrees()));
    EXPECT_FLOAT_EQ(image.offset_v,
                    static_cast<float>((node.node.Box().south_deg - source.Box().south_deg) / source.HeightDegrees()));
  }
}

TEST_F(CutTest, AMissingImageFallsBackToAnAncestor) {
  const Quadcode under = Quadcode::Containing(37, -118, 5);
  pages_.missing_images.insert(under);
  const Cut cut = Select();
  for (const CutNode& node : cut.nodes) {
    if (under.Contains(node.node)) {
      EXPECT_LT(node.images[0].slot, 1005);
    }
  }
}

TEST_F(CutTest, StopsAtTheLimit) {
  view_.error_px = 0.01;
  const Cut cut = Select({60});
  EXPECT_LE(cut.nodes.size(), 60U + 3U * 32U);
  EXPECT_TRUE(cut.at_limit);
  ExpectCover(cut);
}

// A limit must not leave coarse what happens to come last: with every step of the limit the worst that is left
// shrinks, and nothing was replaced that was better than it.
TEST_F(CutTest, WhatALimitLeavesOverIsTheLeast) {
  view_.error_px = 0.05;
  view_.texel_px = 1e6;  // geometry alone
  double before_px = 1e12;
  std::set<Quadcode> replaced_before;
  for (const int limit : {40, 60, 100, 150, 250}) {
    const Cut cut = Select({limit});
    ASSERT_TRUE(cut.at_limit);
    EXPECT_TRUE(cut.behind);
    EXPECT_LT(cut.left_over_error_px, before_px) << limit;
    before_px = cut.left_over_error_px;
    // Refining goes on from where a smaller limit ended.
    std::set<Quadcode> replaced;
    for (const CutNode& node : cut.nodes) {
      for (Quadcode above = node.node; !above.is_root();) replaced.insert(above = above.Parent());
    }
    EXPECT_TRUE(std::includes(replaced.begin(), replaced.end(), replaced_before.begin(), replaced_before.end()));
    replaced_before = std::move(replaced);
  }
}

TEST_F(CutTest, RecordsNest) {
  const Cut cut = Select();
  int depth = 0;
  std::set<uint32_t> drawn;
  for (size_t i = 0; i < cut.records.size(); ++i) {
    const ListRecord& record = cut.records[i];
    if (record.kind == ListRecord::Kind::kCullBegin) {
      ++depth;
      ASSERT_GT(record.skip, i);
      EXPECT_EQ(cut.records[record.skip - 1].kind, ListRecord::Kind::kCullEnd);
    } else if (record.kind == ListRecord::Kind::kCullEnd) {
      --depth;
    } else {
      EXPECT_TRUE(drawn.insert(record.index).second);
    }
    ASSERT_GE(depth, 0);
  }
  EXPECT_EQ(depth, 0);
  EXPECT_EQ(drawn.size(), cut.nodes.size());
}

TEST_F(CutTest, OrthographicViewsMeasureByScaleAlone) {
  LookFrom(37, -118, 2e6, -90);
  view_.projection = Projection::kOrthographic;
  view_.ortho_height_m = 4e6;
  const int coarse = Deepest(Select());
  view_.ortho_height_m = 4e5;
  EXPECT_GT(Deepest(Select()), coarse);
}

// A layer goes on to its next step, of which nothing is there yet.
TEST_F(CutTest, TheStepBeforeIsShownUntilTheNextIsAsFine) {
  const Cut whole = Select();
  before_ = {kImagery};
  view_.image_layers = {{kNextImagery}};
  for (int tree = 0; tree < kTrees; ++tree) pages_.next_images.insert(Quadcode::Root(tree));
  pages_.wanted.clear();
  const Cut cut = Select();
  ASSERT_EQ(cut.nodes.size(), whole.nodes.size());
  std::set<Quadcode> before;
  for (size_t i = 0; i < cut.nodes.size(); ++i) {
    const ImageUse& image = cut.nodes[i].images[0];
    const bool is_root = whole.nodes[i].images[0].source.is_root();
    EXPECT_EQ(image.slot, whole.nodes[i].images[0].slot) << "nothing coarser is flashed in";
    EXPECT_EQ(image.type, is_root ? kNextImagery : kImagery);
    if (!is_root) before.insert(image.source);
  }
  EXPECT_GT(before.size(), 10U);
  EXPECT_EQ(cut.of_step_before[0], static_cast<int>(before.size()));
  EXPECT_TRUE(cut.waiting);
  EXPECT_FALSE(cut.behind) << "what is shown is of another time, but no coarser than the bound asks";
  for (const auto& [key, unused] : pages_.wanted) EXPECT_EQ(key.type, kNextImagery) << "what goes is not asked for";
}

TEST_F(CutTest, AQuadnodeChangesOverWhenItsImageOfTheNextStepIsThere) {
  before_ = {kImagery};
  view_.image_layers = {{kNextImagery}};
  const Quadcode under = Quadcode::Containing(37, -118, 5);
  pages_.next_images = {under, under.Ancestor(3)};
  const Cut cut = Select();
  int of_next = 0;
  std::set<Quadcode> before;
  for (const CutNode& node : cut.nodes) {
    const ImageUse& image = node.images[0];
    EXPECT_GE(image.slot, 1000) << "nothing goes blank";
    if (image.type != kNextImagery) {
      before.insert(image.source);
      continue;
    }
    ++of_next;
    EXPECT_TRUE(pages_.next_images.contains(image.source));
    if (under.Contains(node.node)) {
      EXPECT_EQ(image.source, under);
    }
  }
  EXPECT_GT(of_next, 0);
  EXPECT_EQ(cut.of_step_before[0], static_cast<int>(before.size()));
  before_ = {kNextImagery};  // ended: the best there is of the next
  pages_.next_images.insert(under.Ancestor(0));
  EXPECT_EQ(Select().of_step_before[0], 0);
}

}  // namespace
}  // namespace belvedere

#include "managers/kept_triangles.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

using test::FlatPage;
using test::RandomDeltas;

constexpr double kErrorPx = 0.5;
constexpr double kNearest_m = 20'000;

class KeptTrianglesTest : public testing::Test {
 protected:
  KeptTrianglesTest() {
    std::mt19937 random(1);
    page_ = FlatPage(Quadcode::Containing(37, -118, 7), RandomDeltas(random));
    node_.node = page_->node;
    node_.page = page_.get();
    node_.error_scale = 700;
    node_.nearest_depth_m = kNearest_m;
    sight_.eye_ecef = ToEcef({36.9, -118.2, 60'000});
    sight_.forward_ecef = glm::normalize(ToEcef({37.3, -117.6, 0}) - sight_.eye_ecef);
    sight_.cos_corner = 0.7;
  }
  KeptTriangles::Choice Next() {
    kept_.ForgetUnused();
    return kept_.For(node_, sight_, FrameOf(page_->node), kErrorPx);
  }
  size_t TrianglesFor(double error_px) const {
    std::vector<PostTriangle> triangles;
    PostSelection().Run(node_, sight_, FrameOf(page_->node), error_px, triangles);
    return triangles.size();
  }

  std::unique_ptr<TerrainPage> page_;
  CutNode node_;
  Sight sight_;
  KeptTriangles kept_;
};

TEST_F(KeptTrianglesTest, AreChosenALittleFinerThanAsked) {
  const KeptTriangles::Choice choice = Next();
  EXPECT_EQ(choice.triangles.size(), TrianglesFor(kErrorPx / (1 + kKeepMargin)));
  EXPECT_LE(choice.worst, 1.0 / (1 + kKeepMargin) + 1e-6);
  EXPECT_GT(choice.worst, 0.5);
}

TEST_F(KeptTrianglesTest, AreKeptWhileTheEyeHardlyMoves) {
  const PostTriangle* first = Next().triangles.data();
  for (int step = 1; step <= 5; ++step) {
    sight_.eye_ecef += 70.0 * sight_.forward_ecef;
    const KeptTriangles::Choice choice = Next();
    EXPECT_EQ(choice.triangles.data(), first);
    EXPECT_LE(choice.worst, 1.0);
  }
  EXPECT_EQ(kept_.chosen(), 1U);
}

TEST_F(KeptTrianglesTest, AreChosenAnewWhenTheBoundCouldBreak) {
  Next();
  sight_.eye_ecef += 0.03 * kNearest_m * sight_.forward_ecef;
  Next();
  EXPECT_EQ(kept_.chosen(), 2U);
  EXPECT_LE(Next().worst, 1.0 / (1 + kKeepMargin) + 1e-6);
}

// However an eye wanders, what is left out never grows over the bound.
TEST_F(KeptTrianglesTest, KeepTheBoundAlongAFlight) {
  std::mt19937 random(2);
  std::normal_distribution<double> chance;
  for (int step = 0; step < 200; ++step) {
    sight_.eye_ecef += 80.0 * glm::dvec3(chance(random), chance(random), chance(random));
    sight_.forward_ecef =
        glm::normalize(sight_.forward_ecef + 2e-4 * glm::dvec3(chance(random), chance(random), chance(random)));
    const KeptTriangles::Choice choice = Next();
    EXPECT_LE(choice.worst, 1.0 + 1e-6);
    EXPECT_LE(choice.triangles.size(), TrianglesFor(kErrorPx / (1 + 3 * kKeepMargin)));
    EXPECT_GE(choice.triangles.size(), TrianglesFor(kErrorPx));
  }
  EXPECT_GT(kept_.chosen(), 2U);
  EXPECT_LT(kept_.chosen(), 100U);
}

TEST_F(KeptTrianglesTest, AreChosenAnewForAnotherPageBoundOrPlace) {
  Next();
  std::mt19937 random(3);
  const auto other = FlatPage(page_->node, RandomDeltas(random));
  node_.page = other.get();
  Next();
  EXPECT_EQ(kept_.chosen(), 2U);
  node_.finest = false;
  Next();
  EXPECT_EQ(kept_.chosen(), 3U);
  kept_.ForgetUnused();
  kept_.For(node_, sight_, FrameOf(page_->node), 2 * kErrorPx);
  EXPECT_EQ(kept_.chosen(), 4U);
  node_.error_scale *= 0.9;  // fewer would do
  kept_.For(node_, sight_, FrameOf(page_->node), 2 * kErrorPx);
  EXPECT_EQ(kept_.chosen(), 5U);
}

TEST_F(KeptTrianglesTest, AreForgottenOnceAListDoesNotAskForThem) {
  Next();
  kept_.ForgetUnused();
  kept_.ForgetUnused();
  Next();
  EXPECT_EQ(kept_.chosen(), 2U);
}

}  // namespace
}  // namespace belvedere

#include "managers/kept_triangles.h"

#include "tests/managers/random_earth.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

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
    PostSelection().Run(node_, sight_, FrameOf(page_->node), error_px, {}, 1.0F, triangles);
    return triangles.size();
  }

  static size_t TrianglesOf(const KeptTriangles::Choice& choice) {
    return choice.mesh->inner.size() + choice.mesh->at_border.size();
  }

  std::unique_ptr<TerrainPage> page_;
  CutNode node_;
  Sight sight_;
  KeptTriangles kept_;
};

TEST_F(KeptTrianglesTest, AreChosenALittleFinerThanAsked) {
  const KeptTriangles::Choice choice = Next();
  EXPECT_EQ(TrianglesOf(choice), TrianglesFor(kErrorPx / (1 + kKeepMargin)));
  EXPECT_LE(choice.worst, 1.0 / (1 + kKeepMargin) + 1e-6);
  EXPECT_GT(choice.worst, 0.5);
}

TEST_F(KeptTrianglesTest, AreKeptWhileTheEyeHardlyMoves) {
  const KeptMesh* first = Next().mesh;
  for (int step = 1; step <= 5; ++step) {
    sight_.eye_ecef += 70.0 * sight_.forward_ecef;
    const KeptTriangles::Choice choice = Next();
    EXPECT_EQ(choice.mesh, first);
    EXPECT_FALSE(choice.is_new);
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
    EXPECT_LE(TrianglesOf(choice), TrianglesFor(kErrorPx / (1 + 3 * kKeepMargin)));
    EXPECT_GE(TrianglesOf(choice), TrianglesFor(kErrorPx));
  }
  EXPECT_GT(kept_.chosen(), 2U);
  EXPECT_LT(kept_.chosen(), 100U);
}

// Straight over the ground, where a slant changes most for its size when the eye moves, and aside of the line of view,
// where it does when that turns: no shift along the vertical is seen larger than the bound, in what is kept as in what
// is chosen.
TEST_F(KeptTrianglesTest, KeepEveryPointWithinTheBound) {
  constexpr double kHeight_m = 120'000, kFar_m = 2'000'000;
  std::mt19937 random(4);
  std::normal_distribution<double> chance;
  const auto any = [&] { return glm::dvec3(chance(random), chance(random), chance(random)); };
  node_.greatest_stretch = 1 / sight_.cos_corner;
  uint64_t kept = 0;
  double largest_px = 0;
  for (int flight = 0; flight < 16; ++flight) {
    const bool turns = flight % 2 == 0;
    const double height_m = turns ? kFar_m : kHeight_m;
    const double pixels_per_radian = 0.02 * height_m;  // so that fine posts matter, whose own size does not
    node_.error_scale = pixels_per_radian * node_.greatest_stretch;
    sight_.eye_ecef = ToEcef({37 + 0.1 * chance(random), -118 + 0.1 * chance(random), height_m});
    const glm::dvec3 middle_m = page_->center_ecef - sight_.eye_ecef;
    sight_.forward_ecef =
        glm::normalize(middle_m + (turns ? 0.75 : 0.05) * height_m * glm::normalize(glm::cross(middle_m, any())));
    // A turn alone must not live on what is there for movement.
    node_.nearest_depth_m = turns ? 1'000 : sight_.cos_corner * (height_m - 15'000);
    const glm::dvec3 along_m = (turns ? 0.0 : 200.0) * any();
    const glm::dvec3 turn = (turns ? 4e-3 : 0.0) * (sight_.forward_ecef - glm::normalize(middle_m));
    for (int step = 0; step < 12; ++step) {
      sight_.eye_ecef += along_m;
      sight_.forward_ecef = glm::normalize(sight_.forward_ecef + turn);
      const KeptTriangles::Choice choice = Next();
      kept += choice.is_new ? 0 : 1;
      const auto post = [&](uint16_t vertex) { return static_cast<int>(choice.mesh->vertices[vertex].post()); };
      for (const auto* triangles : {&choice.mesh->inner, &choice.mesh->at_border}) {
        for (const auto& [a, b, c] : *triangles) {
          const double error_px =
              test::SeenErrorOfTriangle_px(*page_, {post(a), post(b), post(c)}, sight_, pixels_per_radian);
          ASSERT_LE(error_px, choice.worst * kErrorPx * 1.0001);
          largest_px = std::max(largest_px, error_px);
        }
      }
      ASSERT_LE(choice.worst, 1.0 + 1e-6);
    }
  }
  EXPECT_GT(kept, 50U);
  EXPECT_GT(largest_px, 0.95 * kErrorPx);
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

// Otherwise leaving one out would move the surface by more than a pixel.
TEST_F(KeptTrianglesTest, PostsStayUntilTheirErrorIsHalfTheBound) {
  constexpr double kWide_px = 4;
  const auto count = [&](double scale) {
    node_.error_scale = scale;
    kept_.ForgetUnused();
    return TrianglesOf(kept_.For(node_, sight_, FrameOf(page_->node), kWide_px));
  };
  const size_t before = count(16'000);
  ASSERT_GT(before, 100U);
  EXPECT_EQ(count(9'000), before) << "errors are 0.56 of what they were";
  const size_t later = count(4'000);
  EXPECT_LT(later, before);
  KeptTriangles fresh;
  EXPECT_GT(later, TrianglesOf(fresh.For(node_, sight_, FrameOf(page_->node), kWide_px)));
}

// Every vertex is that of its post, once, and those on the border are known.
TEST_F(KeptTrianglesTest, HaveOneVertexAPost) {
  const KeptMesh& mesh = *Next().mesh;
  std::set<uint32_t> posts;
  for (const ListVertex& vertex : mesh.vertices) {
    EXPECT_TRUE(posts.insert(vertex.post()).second);
    const TerrainVertex& of_page = page_->vertices[vertex.post()];
    EXPECT_EQ(std::tie(vertex.x, vertex.y, vertex.z), std::tie(of_page.x, of_page.y, of_page.z));
  }
  const auto at_border = [&](uint16_t vertex) {
    const int column = static_cast<int>(mesh.vertices[vertex].post()) % kPosts;
    const int row = static_cast<int>(mesh.vertices[vertex].post()) / kPosts;
    return column == 0 || column == kCells || row == 0 || row == kCells;
  };
  for (const KeptMesh::Triangle& t : mesh.inner) EXPECT_FALSE(at_border(t.a) || at_border(t.b) || at_border(t.c));
  for (const KeptMesh::Triangle& t : mesh.at_border) EXPECT_TRUE(at_border(t.a) || at_border(t.b) || at_border(t.c));
  for (const uint16_t vertex : mesh.border_vertices) EXPECT_TRUE(at_border(vertex));
  EXPECT_GE(mesh.border_vertices.size(), 4U);
}

// What was left out beside the picture is chosen anew before it can come into it.
TEST_F(KeptTrianglesTest, AreChosenAnewWhenThePictureTurnsTowardsWhatIsCoarse) {
  const glm::dvec3 side = glm::normalize(glm::cross(sight_.forward_ecef, sight_.eye_ecef));
  sight_.inwards_ecef[2] = side;
  const size_t before = TrianglesOf(Next());
  sight_.inwards_ecef[2] = glm::normalize(side + 0.5 * kBesideGuard * sight_.forward_ecef);
  Next();
  EXPECT_EQ(kept_.chosen(), 1U);
  sight_.inwards_ecef[2] = glm::normalize(side + 1.5 * kBesideGuard * sight_.forward_ecef);
  EXPECT_GT(TrianglesOf(Next()), before);
  EXPECT_EQ(kept_.chosen(), 2U);
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

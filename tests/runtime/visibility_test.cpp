#include "runtime/earth/visibility.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <random>

namespace belvedere {
namespace {

// Reverse-Z with an infinite far plane, looking along -z of an eye at the origin.
glm::dmat4 ClipFromView(double tangent, double near_m) {
  glm::dmat4 clip(0.0);
  clip[0][0] = clip[1][1] = 1 / tangent;
  clip[2][3] = -1;
  clip[3][2] = near_m;
  return clip;
}

TEST(Frustum, HidesWhatIsBeside) {
  const Frustum frustum(ClipFromView(1.0, 0.5));  // 90 degrees each way
  EXPECT_FALSE(frustum.Hides({{0, 0, -10}, 1}));
  EXPECT_TRUE(frustum.Encloses({{0, 0, -10}, 1}));
  EXPECT_TRUE(frustum.Hides({{0, 0, 10}, 1}));
  EXPECT_TRUE(frustum.Hides({{20, 0, -10}, 1}));
  EXPECT_TRUE(frustum.Hides({{0, -20, -10}, 1}));
  EXPECT_FALSE(frustum.Hides({{10, 0, -10}, 1}));  // half in
  EXPECT_FALSE(frustum.Encloses({{10, 0, -10}, 1}));
  EXPECT_FALSE(frustum.Hides({{0, 0, -1e8}, 1}));   // there is no far plane
  EXPECT_TRUE(frustum.Hides({{0, 0, -0.2}, 0.1}));  // before the near plane
  EXPECT_FALSE(frustum.Hides({{0, 0, 0}, 5}));      // around the eye
}

TEST(Frustum, NeverHidesASphereOfWhichAPointIsInside) {
  const glm::dmat4 clip = ClipFromView(0.7, 1.0);
  const Frustum frustum(clip);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-50, 50), size(0.1, 20);
  std::normal_distribution<double> direction;
  for (int i = 0; i < 5000; ++i) {
    const BoundingSphere sphere{{place(random), place(random), place(random)}, size(random)};
    const glm::dvec3 towards = glm::normalize(glm::dvec3(direction(random), direction(random), direction(random)));
    const glm::dvec4 point = clip * glm::dvec4(sphere.center_ecef + 0.999 * sphere.radius_m * towards, 1);
    const bool inside = std::abs(point.x) < point.w && std::abs(point.y) < point.w && point.z < point.w;
    ASSERT_FALSE(inside && frustum.Hides(sphere));
    ASSERT_FALSE(!inside && frustum.Encloses(sphere));
  }
}

TEST(Horizon, HidesTheOtherSideOfTheEarth) {
  const Horizon horizon(ToEcef({0, 0, 1000}));
  EXPECT_TRUE(horizon.Hides({ToEcef({0, 180, 0}), 1000}));
  EXPECT_TRUE(horizon.Hides({ToEcef({0, 20, 0}), 1000}));
  EXPECT_FALSE(horizon.Hides({ToEcef({0, 0.5, 0}), 1000}));
  EXPECT_FALSE(horizon.Hides({ToEcef({0, 20, 3e6}), 1000}));  // high above what is hidden
  EXPECT_FALSE(horizon.Hides({ToEcef({0, 20, 0}), 3e6}));     // large enough to look over
  EXPECT_FALSE(Horizon().Hides({ToEcef({0, 180, 0}), 1}));
}

// Whatever has a free line of sight past the deepest ground is not hidden.
void ExpectWhatCanBeSeenIsNotHidden(double exaggeration) {
  const double lowest_m = kDeepestGround_m * exaggeration;
  const glm::dvec3 scale(1 / (kEquatorialRadius_m + lowest_m), 1 / (kEquatorialRadius_m + lowest_m),
                         1 / (kPolarRadius_m + lowest_m));
  std::mt19937 random(8);
  std::uniform_real_distribution<double> latitude(-90, 90), longitude(-180, 180), power(0, 7), spread(-15, 15);
  int seen = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double at_latitude = latitude(random), at_longitude = longitude(random);
    const glm::dvec3 eye = ToEcef({at_latitude, at_longitude, std::pow(10.0, power(random))});
    const glm::dvec3 point =
        ToEcef({std::clamp(at_latitude + spread(random), -90.0, 90.0), at_longitude + spread(random), 50});
    // Nearest approach of the line of sight to the Earth's middle, in the space where the deep ellipsoid is a unit
    // sphere.
    const glm::dvec3 from = eye * scale;
    const glm::dvec3 along = point * scale - from;
    const double share = std::clamp(-glm::dot(from, along) / glm::dot(along, along), 0.0, 1.0);
    const glm::dvec3 nearest = from + share * along;
    if (glm::dot(nearest, nearest) < 1) continue;
    ++seen;
    ASSERT_FALSE(Horizon(eye, exaggeration).Hides({point, 0.01}));
    ASSERT_FALSE(Horizon(eye, exaggeration).Hides({point, 5000}));
  }
  EXPECT_GT(seen, 1000);
}

TEST(Horizon, NeverHidesWhatCanBeSeen) {
  ExpectWhatCanBeSeenIsNotHidden(1);
}

// Over a sea ten times as deep one sees further.
TEST(Horizon, NeverHidesWhatCanBeSeenOverExaggeratedGround) {
  ExpectWhatCanBeSeenIsNotHidden(10);
  const glm::dvec3 eye = ToEcef({0, 0, 1000});
  const BoundingSphere beyond{ToEcef({0, 8, 0}), 1000};
  EXPECT_TRUE(Horizon(eye).Hides(beyond));
  EXPECT_FALSE(Horizon(eye, 10).Hides(beyond));
}

}  // namespace
}  // namespace belvedere

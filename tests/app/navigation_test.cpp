#include "runtime/app/navigation.h"

#include "runtime/app/overview.h"
#include "runtime/app/tether.h"
#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <random>

namespace belvedere {
namespace {

const GroundHeight kSea = [](double, double) { return 0.0; };
// Hills of a kilometre, a few kilometres apart.
const GroundHeight kHills = [](double latitude_deg, double longitude_deg) {
  return 1000.0 + 1000.0 * std::sin(latitude_deg * 200) * std::cos(longitude_deg * 200);
};

PicturePoint Projected(const Camera& camera, const Lens& lens, const glm::dvec3& ecef) {
  const glm::dvec3 in_camera = glm::transpose(camera.ecef_from_camera) * (ecef - camera.eye_ecef);
  const double tan_half = std::tan(0.5 * lens.vertical_fov.value);
  const double x = in_camera.x / -in_camera.z / (tan_half * lens.aspect());
  const double y = in_camera.y / -in_camera.z / tan_half;
  return {(x + 1) * 0.5 * lens.width_px, (1 - y) * 0.5 * lens.height_px};
}

double HeightOver(const Camera& camera, const GroundHeight& ground) {
  const Geodetic place = ToGeodetic(camera.eye_ecef);
  return place.height_m - ground(place.latitude_deg, place.longitude_deg);
}

struct Start {
  const char* name;
  Geodetic position;
  double heading_deg, pitch_deg;
};
const Start kStarts[] = {
    {"space", {10, 20, 12'000e3}, 0, -90},      {"sierra", {37.2, -118.4, 5'000}, 330, -20},
    {"pole", {89.9, 30, 50e3}, 45, -60},        {"south pole", {-90, 0, 400e3}, 0, -80},
    {"date line", {5, 179.999, 30e3}, 90, -35}, {"near the ground", {45, 7, 2'300}, 200, -15},
};

TEST(NavigationTest, SightLinesMeetTheGroundWhereItIs) {
  const Lens lens;
  for (const Start& start : kStarts) {
    SCOPED_TRACE(start.name);
    const Camera camera = Camera::At(start.position, start.heading_deg, start.pitch_deg);
    const PicturePoint middle{512, 500};
    const auto met = MeetGround(SightThrough(camera, lens, middle), kHills);
    ASSERT_TRUE(met.has_value());
    const Geodetic place = ToGeodetic(*met);
    const double distance_m = glm::distance(*met, camera.eye_ecef);
    EXPECT_NEAR(place.height_m, kHills(place.latitude_deg, place.longitude_deg), 1e-5 * distance_m + 1e-3);
    const PicturePoint seen = Projected(camera, lens, *met);
    EXPECT_NEAR(seen.x_px, middle.x_px, 1e-3);
    EXPECT_NEAR(seen.y_px, middle.y_px, 1e-3);
  }
}

TEST(NavigationTest, SkyMeetsNoGround) {
  const Camera camera = Camera::At({37, -118, 5'000}, 0, 30);
  EXPECT_FALSE(MeetGround(SightThrough(camera, Lens{}, {512, 384}), kSea).has_value());
}

TEST(NavigationTest, PannedPointStaysUnderTheCursor) {
  const Lens lens;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step_px(-12, 12);
  for (const Start& start : kStarts) {
    SCOPED_TRACE(start.name);
    Camera camera = Camera::At(start.position, start.heading_deg, start.pitch_deg);
    PicturePoint cursor{512, 520};
    const glm::dvec3 held = PointUnder(camera, lens, cursor, kSea);
    for (int i = 0; i < 20; ++i) {
      cursor.x_px += step_px(random);
      cursor.y_px += std::abs(step_px(random)) * (i % 2 == 0 ? 1 : -1);
      camera = Pan(camera, lens, held, cursor, kSea);
      const PicturePoint seen = Projected(camera, lens, held);
      ASSERT_NEAR(seen.x_px, cursor.x_px, 0.5);
      ASSERT_NEAR(seen.y_px, cursor.y_px, 0.5);
      ASSERT_GE(HeightOver(camera, kSea), kLeastClearance_m * 0.999);
    }
  }
}

TEST(NavigationTest, PanKeepsTheHorizonLevel) {
  const Lens lens;
  Camera camera = Camera::At({37, -118, 9'000}, 30, -20);
  const glm::dvec3 held = PointUnder(camera, lens, {400, 600}, kSea);
  for (int i = 1; i <= 60; ++i) camera = Pan(camera, lens, held, {400.0 + 5 * i, 600.0}, kSea);
  EXPECT_NEAR(AttitudeOf(camera).roll_deg, 0.0, 1e-6);
}

TEST(NavigationTest, PanGoesOverThePole) {
  const Lens lens;
  Camera camera = Camera::At({89.99, 0, 100e3}, 0, -90);
  const PicturePoint from{512, 100}, to{512, 700};
  const glm::dvec3 held = PointUnder(camera, lens, from, kSea);
  camera = Pan(camera, lens, held, to, kSea);
  EXPECT_NEAR(Projected(camera, lens, held).y_px, to.y_px, 0.5);
  const Geodetic place = ToGeodetic(camera.eye_ecef);
  EXPECT_NEAR(std::abs(place.longitude_deg), 180.0, 1.0);  // on the other side
  EXPECT_NEAR(glm::length(camera.ecef_from_camera[0]), 1.0, 1e-12);
}

TEST(NavigationTest, ZoomTakesAFixedShareOfTheDistanceTowardsTheCursor) {
  const Lens lens;
  for (const Start& start : kStarts) {
    SCOPED_TRACE(start.name);
    const Camera camera = Camera::At(start.position, start.heading_deg, start.pitch_deg);
    const PicturePoint cursor{600, 560};
    const glm::dvec3 target = PointUnder(camera, lens, cursor, kSea);
    const Camera zoomed = Zoom(camera, lens, cursor, 1, kSea);
    EXPECT_NEAR(glm::distance(zoomed.eye_ecef, target) / glm::distance(camera.eye_ecef, target), 0.9, 1e-9);
    const PicturePoint seen = Projected(zoomed, lens, target);
    EXPECT_NEAR(seen.x_px, cursor.x_px, 1e-3);
    EXPECT_NEAR(seen.y_px, cursor.y_px, 1e-3);
  }
}

TEST(NavigationTest, ZoomingOutFarTurnsBackToTheEarth) {
  const Lens lens;
  Camera camera = Camera::At({37, -118, 5'000}, 0, -15);
  for (int i = 0; i < 200; ++i) camera = Zoom(camera, lens, {512, 700}, -1, kSea);
  EXPECT_LE(ToGeodetic(camera.eye_ecef).height_m, kFarthest_m * 1.000001);
  EXPECT_GT(glm::dot(camera.forward(), -glm::normalize(camera.eye_ecef)), std::cos(5 * kRadiansPerDegree));
}

TEST(NavigationTest, NothingGoesUnderTheGround) {
  const Lens lens;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  Camera camera = Camera::At({36.9, -118.5, 4'000}, 0, -30);
  glm::dvec3 held = PointUnder(camera, lens, {512, 600}, kHills);
  for (int i = 0; i < 400; ++i) {
    const PicturePoint point{512 + 400 * unit(random), 384 + 350 * unit(random)};
    switch (i % 5) {
      case 0: camera = Zoom(camera, lens, point, 3 + 3 * unit(random), kHills); break;
      case 1:
        camera = Orbit(camera, PointUnder(camera, lens, point, kHills), 40 * unit(random), 60 * unit(random), kHills);
        break;
      case 2:
        camera = Fly(camera, {unit(random), unit(random), unit(random), unit(random), unit(random)}, 0.5, kHills);
        break;
      case 3: held = PointUnder(camera, lens, point, kHills); break;
      default: camera = Pan(camera, lens, held, point, kHills);
    }
    ASSERT_GE(HeightOver(camera, kHills), 0.999 * kLeastClearance_m) << "after step " << i;
    ASSERT_NEAR(glm::determinant(camera.ecef_from_camera), 1.0, 1e-9);
  }
}

TEST(NavigationTest, OrbitKeepsThePivotWhereItIsAndStopsAtStraightDown) {
  const Lens lens;
  Camera camera = Camera::At({46, 7, 8'000}, 10, -40);
  const PicturePoint cursor{300, 500};
  const glm::dvec3 pivot = PointUnder(camera, lens, cursor, kSea);
  const double distance_m = glm::distance(camera.eye_ecef, pivot);
  camera = Orbit(camera, pivot, 25, 12, kSea);
  EXPECT_NEAR(glm::distance(camera.eye_ecef, pivot), distance_m, 1e-3);
  EXPECT_NEAR(Projected(camera, lens, pivot).x_px, cursor.x_px, 0.01);
  EXPECT_NEAR(Projected(camera, lens, pivot).y_px, cursor.y_px, 0.01);
  for (int i = 0; i < 30; ++i) camera = Orbit(camera, pivot, 0, -10, kSea);
  const Geodetic place = ToGeodetic(pivot);
  EXPECT_LT(glm::dot(camera.forward(), UpAt(place.latitude_deg, place.longitude_deg)), -0.999999);
}

TEST(NavigationTest, LookTurnsByTheFieldOfView) {
  const Lens lens{1024, 768, Radians::FromDegrees(60)};
  const Camera camera = Camera::At({10, 179.9, 1'000}, 350, 0);
  const Camera turned = Look(camera, lens, 0, 0.5);
  EXPECT_NEAR(AttitudeOf(turned).pitch_deg, 30, 1e-9);
  const double horizontal_fov_deg = 2 * std::atan(std::tan(30 * kRadiansPerDegree) * 4 / 3) * kDegreesPerRadian;
  EXPECT_NEAR(std::remainder(AttitudeOf(Look(camera, lens, 1, 0)).heading_deg - 350 - horizontal_fov_deg, 360), 0,
              1e-9);
  EXPECT_NEAR(AttitudeOf(Look(camera, lens, 0, -10)).pitch_deg, -90, 1e-9);
}

TEST(NavigationTest, FlightKeepsItsHeightAndGrowsFasterWithIt) {
  const Camera low = Camera::At({0, 179.99, 1'000}, 90, -10), high = Camera::At({0, 179.99, 100e3}, 90, -10);
  const Camera low_flown = Fly(low, {1, 0, 0, 0, 0}, 1, kSea), high_flown = Fly(high, {1, 0, 0, 0, 0}, 1, kSea);
  EXPECT_NEAR(ToGeodetic(low_flown.eye_ecef).height_m, 1'000, 1e-6);
  EXPECT_NEAR(glm::distance(low.eye_ecef, low_flown.eye_ecef), kFlightHeightsPerSecond * 1'000, 1);
  EXPECT_NEAR(glm::distance(high.eye_ecef, high_flown.eye_ecef), kFlightHeightsPerSecond * 100e3, 200);
  const double longitude_deg = ToGeodetic(high_flown.eye_ecef).longitude_deg;
  EXPECT_LT(longitude_deg, -179.3);  // over 180 E
  EXPECT_NEAR(AttitudeOf(low_flown).pitch_deg, -10, 1e-6);
}

TEST(NavigationTest, FlightCrossesThePole) {
  Camera camera = Camera::At({89.5, 20, 20e3}, 0, -20);
  for (int i = 0; i < 12; ++i) camera = Fly(camera, {1, 0, 0, 0, 0}, 1, kSea);
  const Geodetic place = ToGeodetic(camera.eye_ecef);
  EXPECT_NEAR(place.longitude_deg, -160, 1e-3);
  EXPECT_NEAR(std::abs(AttitudeOf(camera).heading_deg), 180, 1e-3);
  EXPECT_NEAR(place.height_m, 20e3, 1e-3);
}

TEST(NavigationTest, AttitudeReadsBackWhatAtMade) {
  for (const double heading : {-170.0, -45.0, 0.0, 133.0}) {
    for (const double pitch : {-90.0, -60.0, 0.0, 45.0}) {
      const double roll = pitch == -90.0 ? 0.0 : 20.0;
      const Attitude attitude = AttitudeOf(Camera::At({-33, 151, 700}, heading, pitch, roll));
      EXPECT_NEAR(attitude.heading_deg, heading, 1e-6);
      EXPECT_NEAR(attitude.pitch_deg, pitch, 1e-6);
      EXPECT_NEAR(attitude.roll_deg, roll, 1e-6);
    }
  }
}

TEST(OverviewTest, PannedAndZoomedPlacesStayUnderTheCursor) {
  const Lens lens{640, 480, {}};
  const Overview starts[] = {{37.6, -119, 400e3}, {10, 179.8, 500e3}, {-60, 20, 3'000e3}, {0, 0, 12'000e3}};
  for (const Overview& start : starts) {
    const Geodetic held = PlaceUnder(start, lens, {400, 200});
    const Overview panned = Panned(start, lens, held, {250, 300});
    const Geodetic under = PlaceUnder(panned, lens, {250, 300});
    EXPECT_LT(glm::distance(ToEcef(under), ToEcef(held)), 0.5 * start.span_m / lens.height_px);
    const Overview zoomed = Zoomed(start, lens, {400, 200}, 1);
    EXPECT_NEAR(zoomed.span_m, 0.9 * start.span_m, 1e-6);
    EXPECT_LT(glm::distance(ToEcef(PlaceUnder(zoomed, lens, {400, 200})), ToEcef(held)),
              0.5 * zoomed.span_m / lens.height_px);
  }
}

TEST(OverviewTest, NorthStaysUpAndThePoleIsNotPassed) {
  const Lens lens{640, 480, {}};
  Overview overview{89, 0, 1'000e3};
  overview = Panned(overview, lens, PlaceUnder(overview, lens, {320, 10}), {320, 470});
  EXPECT_LE(std::abs(overview.latitude_deg), kOverviewNorthernmost_deg);
  EXPECT_NEAR(AttitudeOf(CameraOf(overview)).roll_deg, 0, 1e-6);
}

TEST(TetherTest, LooksAtTheTargetFromBehind) {
  const Geodetic place{37, 179.9999, 8'000};
  const LevelAxes level = LevelAxesAt(place.latitude_deg, place.longitude_deg);
  Pose target;
  target.position_ecef = ToEcef(place);
  target.ecef_from_body = glm::dmat3(level.east, -level.north, -level.up);  // flies east
  const Camera camera = CameraOf(Tether{200, 0, 10, true}, target, kSea);
  EXPECT_NEAR(glm::distance(camera.eye_ecef, target.position_ecef), 200, 1e-6);
  EXPECT_NEAR(glm::dot(camera.forward(), glm::normalize(target.position_ecef - camera.eye_ecef)), 1, 1e-12);
  EXPECT_LT(glm::dot(camera.eye_ecef - target.position_ecef, level.east), -190);
  EXPECT_GT(glm::dot(camera.eye_ecef - target.position_ecef, level.up), 30);
}

TEST(TetherTest, GodsEyeLooksStraightDownNorthUp) {
  const Geodetic place{37, -118, 3'000};
  const LevelAxes level = LevelAxesAt(place.latitude_deg, place.longitude_deg);
  Pose target;
  target.position_ecef = ToEcef(place);
  target.ecef_from_body = glm::dmat3(level.east, -level.north, -level.up);
  const Camera camera = CameraOf(Tether{20e3, 0, 90, false}, target, kSea);
  EXPECT_NEAR(glm::dot(camera.forward(), level.up), -1, 1e-12);
  EXPECT_NEAR(glm::dot(camera.ecef_from_camera[1], level.north), 1, 1e-12);
}

TEST(TetherTest, GroundLiftsTheCameraWhichLooksDownAtTheTarget) {
  const Geodetic place{37, -118, 1'000};
  Pose target;
  target.position_ecef = ToEcef(place);
  const GroundHeight high = [](double, double) { return 1'500.0; };
  const Camera camera = CameraOf(Tether{300, 0, 5, false}, target, high);
  EXPECT_GE(HeightOver(camera, high), 0.999 * kLeastClearance_m);
  EXPECT_NEAR(glm::dot(camera.forward(), glm::normalize(target.position_ecef - camera.eye_ecef)), 1, 1e-9);
}

}  // namespace
}  // namespace belvedere

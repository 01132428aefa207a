#include "runtime/app/camera_path.h"

#include "runtime/app/percentiles.h"
#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace belvedere {
namespace {

const std::string kHeader = "t_s,lat_deg,lon_deg,height_m,heading_deg,pitch_deg,roll_deg,vfov_deg\n";

CameraPath PathOf(const std::string& rows) {
  const Result<CameraPath> path = CameraPath::Parse(kHeader + rows, "path.csv");
  EXPECT_TRUE(path.ok()) << path.message();
  return *path;
}

TEST(CameraPathTest, PassesThroughItsRows) {
  const CameraPath path = PathOf("10,0,0,1000,0,-10,0,60\n12,1,2,3000,90,-20,5,50\n15,3,1,500,80,-30,-5,40\n");
  EXPECT_EQ(path.length_s(), 5);
  const CameraPose middle = path.PoseAt(2);
  EXPECT_NEAR(middle.position.latitude_deg, 1, 1e-9);
  EXPECT_NEAR(middle.position.longitude_deg, 2, 1e-9);
  EXPECT_NEAR(middle.position.height_m, 3000, 1e-9);
  EXPECT_NEAR(middle.heading_deg, 90, 1e-9);
  EXPECT_NEAR(middle.vfov_deg, 50, 1e-9);
  EXPECT_NEAR(path.PoseAt(-1).position.height_m, 1000, 1e-9);
  EXPECT_NEAR(path.PoseAt(99).position.height_m, 500, 1e-9);
  EXPECT_EQ(path.VelocityAt(99), glm::dvec3(0.0));
}

TEST(CameraPathTest, GoesTheShorterWayOverTheDateLineAndNorth) {
  const CameraPath path = PathOf("0,10,179.5,1000,350,0,0,60\n1,10,-179.5,1000,10,0,0,60\n");
  const CameraPose pose = path.PoseAt(0.5);
  EXPECT_NEAR(std::abs(pose.position.longitude_deg), 180, 1e-9);
  EXPECT_NEAR(std::remainder(pose.heading_deg, 360), 0, 1e-9);
}

TEST(CameraPathTest, CrossesThePole) {
  const CameraPath path = PathOf("0,89,0,5000,0,0,0,60\n1,89,180,5000,180,0,0,60\n");
  EXPECT_NEAR(path.PoseAt(0.5).position.latitude_deg, 90, 1e-9);
}

TEST(CameraPathTest, NeverDivesBelowTheLowerOfTwoRows) {
  const CameraPath path =
      PathOf("0,0,0,12000000,0,0,0,60\n1,0,0,5000,0,0,0,60\n2,0,0.01,5000,0,0,0,60\n3,0,0.02,5001,0,0,0,60\n");
  for (double t = 0; t <= 3; t += 0.01) EXPECT_GE(path.PoseAt(t).position.height_m, 5000 - 1e-6) << t;
}

TEST(CameraPathTest, VelocityIsTheDerivativeAndHasNoSteps) {
  const CameraPath path = PathOf(
      "0,37,-118,5000,0,0,0,60\n1,37.01,-118,5000,0,0,0,60\n2,37.03,-118.01,5100,0,0,0,60\n"
      "3,37.05,-118.02,5200,0,0,0,60\n");
  for (const double t : {0.3, 0.999, 1.001, 1.7, 2.0}) {
    const glm::dvec3 moved = path.PoseAt(t + 0.01).eye_ecef() - path.PoseAt(t - 0.01).eye_ecef();
    EXPECT_LT(glm::distance(moved / 0.02, path.VelocityAt(t)), 0.02 * glm::length(path.VelocityAt(t))) << t;
  }
  EXPECT_LT(glm::distance(path.VelocityAt(0.998), path.VelocityAt(1.002)), 20);
}

TEST(CameraPathTest, SaysWhatIsWrongWithLineAndReason) {
  const auto message = [](const std::string& text) { return CameraPath::Parse(text, "p.csv").message(); };
  EXPECT_NE(message("lat,lon\n").find("p.csv:1: the header must be t_s,"), std::string::npos);
  EXPECT_NE(message(kHeader + "0,1,2,3,4,5,6\n").find("p.csv:2: expected 8 numbers"), std::string::npos);
  EXPECT_NE(message(kHeader + "0,1,2,3,4,5,6,60\n0,1,2,3,4,5,6,60\n").find("p.csv:3: t_s 0 is not after"),
            std::string::npos);
  EXPECT_NE(message(kHeader + "0,91,2,3,4,5,6,60\n").find("p.csv:2: lat_deg 91"), std::string::npos);
  EXPECT_NE(message(kHeader + "0,nan,2,3,4,5,6,60\n").find("p.csv:2: expected"), std::string::npos);
  EXPECT_NE(message(kHeader + "0,1,2,3,4,5,6,60\n").find("at least two rows"), std::string::npos);
  EXPECT_NE(CameraPath::Load("/nowhere/path.csv").message().find("/nowhere/path.csv"), std::string::npos);
}

TEST(CameraPathTest, TourOfTheDemoGoesFromSpaceToTheSierra) {
  const Result<CameraPath> path = CameraPath::Load(std::string(BELVEDERE_SOURCE_DIR) + "/runtime/app/demo/tour.csv");
  ASSERT_TRUE(path.ok()) << path.message();
  EXPECT_EQ(path->length_s(), 120);
  EXPECT_NEAR(path->PoseAt(0).position.height_m, 12'000e3, 1);
  for (double t = 60; t <= 120; t += 0.25) {
    const Geodetic place = path->PoseAt(t).position;
    EXPECT_GT(place.height_m, 4'500);
    EXPECT_LT(place.height_m, 5'500);
    EXPECT_TRUE(place.latitude_deg > 36.634 && place.latitude_deg < 38.627) << t;
    EXPECT_TRUE(place.longitude_deg > -120.756 && place.longitude_deg < -117.305) << t;
  }
}

TEST(PercentilesTest, AreByNearestRank) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  const Percentiles percentiles = PercentilesOf(values);
  EXPECT_EQ(percentiles.p50, 50);
  EXPECT_EQ(percentiles.p95, 95);
  EXPECT_EQ(percentiles.p99, 99);
  EXPECT_EQ(percentiles.max, 100);
  EXPECT_EQ(MeanOf(values), 50.5);
  EXPECT_EQ(PercentileOf(std::vector<double>{3}, 0.01), 3);
  EXPECT_EQ(PercentilesOf({}).max, 0);
}

TEST(PercentilesTest, AValueIsHeldAgainstThoseAroundIt) {
  // Two phases, 1 and 10, with one value of 5 in the first: nothing beside the second, five times its like.
  std::vector<double> times_s, values;
  for (int i = 0; i < 100; ++i) {
    times_s.push_back(i);
    values.push_back(i < 50 ? 1 : 10);
  }
  values[20] = 5;
  const std::vector<double> over = OverMedianAround(times_s, values, 3);
  ASSERT_EQ(over.size(), values.size());
  EXPECT_EQ(over[20], 5);
  EXPECT_EQ(over[0], 1);
  EXPECT_EQ(over[49], 1) << "four of the seven around it are of the first phase";
  EXPECT_EQ(over[50], 1);
  EXPECT_EQ(over[99], 1);
  EXPECT_EQ(std::count(over.begin(), over.end(), 1), 99);
  EXPECT_TRUE(OverMedianAround({}, {}, 3).empty());
}

}  // namespace
}  // namespace belvedere

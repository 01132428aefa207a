#include "runtime/earth/frame.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

TEST(Frame, FinerQuadnodesUseThatOfTheirLevel8Ancestor) {
  const Quadcode node = Quadcode::Containing(37, -118, 15);
  EXPECT_EQ(FrameNode(node), node.Ancestor(8));
  EXPECT_EQ(FrameNode(node.Ancestor(8)), node.Ancestor(8));
  EXPECT_EQ(FrameNode(node.Ancestor(5)), node.Ancestor(5));
  EXPECT_EQ(FrameOf(node).origin_ecef, FrameOf(node.Ancestor(8)).origin_ecef);
}

TEST(Frame, StandsOnTheEllipsoidAtTheCentre) {
  for (const Quadcode node :
       {Quadcode::Root(3), Quadcode::Containing(37, -118, 8), Quadcode::FromColumnRow(8, -1, 0)}) {
    const Frame frame = FrameOf(node);
    const GeoBox box = node.Box();
    const double latitude = 0.5 * (box.south_deg + box.north_deg);
    const double longitude = 0.5 * (box.west_deg + box.east_deg);
    EXPECT_LT(glm::distance(frame.origin_ecef, ToEcef({latitude, longitude, 0})), 1e-9);
    EXPECT_LT(glm::distance(frame.ToEcef({0, 0, 250}), ToEcef({latitude, longitude, 250})), 1e-6);
    const glm::dvec3 x = frame.ecef_from_frame[0], y = frame.ecef_from_frame[1], z = frame.ecef_from_frame[2];
    EXPECT_LT(glm::distance(glm::cross(y, z), x), 1e-14);
    EXPECT_NEAR(x.z, 0, 1e-15);  // east lies in the plane of the equator
    EXPECT_GT(y.z, 0);           // north
  }
}

TEST(Frame, GoesThereAndBack) {
  const Frame frame = FrameOf(Quadcode::Containing(-70, 179.9, 12));
  const glm::dvec3 local{1234.5, -6789.25, 321.125};
  EXPECT_LT(glm::distance(frame.ToFrame(frame.ToEcef(local)), local), 1e-8);
  const glm::dvec4 by_matrix = frame.EcefFromFrame() * glm::dvec4(local, 1);
  EXPECT_LT(glm::distance(glm::dvec3(by_matrix), frame.ToEcef(local)), 1e-8);
}

TEST(Frame, IsSmallEnoughForFloats) {
  // The corner of a level-8 quadnode at the equator, where they are largest, with the highest ground on it.
  const Quadcode node = Quadcode::Containing(0.01, 0.01, 8);
  const GeoBox box = node.Box();
  const glm::dvec3 corner = FrameOf(node).ToFrame(ToEcef({box.south_deg, box.west_deg, 8900}));
  EXPECT_LT(glm::length(glm::dvec3(glm::vec3(corner)) - corner), 1e-3);
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(std::abs(corner[axis]), 16'384);  // where floats are 1 mm apart
}

}  // namespace
}  // namespace belvedere

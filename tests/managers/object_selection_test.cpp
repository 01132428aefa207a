#include "managers/object_selection.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

class ObjectSelectionTest : public testing::Test {
 protected:
  ObjectSelectionTest() {
    view_.eye_ecef = ToEcef({37, -118, 5000});
    view_.ecef_from_camera = CameraAxes(37, -118, {}, {}, {});  // level, to the north
  }
  ObjectShow Show(double north_m, double height_m = 5000, bool has_model = true) const {
    const glm::dvec3 there = ToEcef({37 + north_m / 111'000, -118, height_m});
    return HowToShow(view_, MatricesOf(view_, 0, 5000), there, 20, has_model);
  }
  ViewParameters view_;
};

TEST_F(ObjectSelectionTest, NearIsAModelFarASymbolFartherNothing) {
  EXPECT_EQ(Show(500).how, ObjectShow::How::kModel);
  EXPECT_EQ(Show(20'000).how, ObjectShow::How::kSymbol);
  EXPECT_EQ(Show(150'000).how, ObjectShow::How::kNot);
  EXPECT_EQ(Show(500, 5000, false).how, ObjectShow::How::kSymbol);
}

TEST_F(ObjectSelectionTest, SizeIsTheSpheresDiameterInPixels) {
  const ObjectShow show = Show(10'000);
  const double pixels_per_radian = 384 / std::tan(0.5 * view_.vertical_fov.value);
  EXPECT_NEAR(show.size_px, 40 * pixels_per_radian / 10'000, 0.02 * show.size_px);
}

TEST_F(ObjectSelectionTest, BehindTheEyeAndBehindTheHorizonAreLeftOut) {
  EXPECT_EQ(Show(-5000).how, ObjectShow::How::kNot);
  view_.symbols = true;  // size does not matter then
  EXPECT_EQ(Show(200'000, 5000).how, ObjectShow::How::kSymbol);
  EXPECT_EQ(Show(2'000'000, 5000).how, ObjectShow::How::kNot);
}

TEST_F(ObjectSelectionTest, TheNearPlaneFollowsTheEyeThoughTheGroundHeightIsStale) {
  EXPECT_LT(MatricesOf(view_, 0, 6e6).near_m, 5);  // a list made from space; the eye is at 5 km by now
  EXPECT_LT(MatricesOf(view_, 0, 100).near_m, MatricesOf(view_, 0, 5000).near_m);
}

TEST_F(ObjectSelectionTest, TheOverviewShowsSymbols) {
  view_.symbols = true;
  EXPECT_EQ(Show(500).how, ObjectShow::How::kSymbol);
}

TEST(ObjectSelection, DetailIsTheCoarsestUnderAPixel) {
  ModelPage model;
  model.details = {{0, 3, 0.0F}, {3, 3, 0.1F}, {6, 3, 1.0F}};
  EXPECT_EQ(ChooseDetail(model, 100), 0);
  EXPECT_EQ(ChooseDetail(model, 5), 1);
  EXPECT_EQ(ChooseDetail(model, 0.5), 2);
}

TEST(ObjectSelection, AVehicleStandsUprightOnASlopeAndKeepsItsHeading) {
  const LevelAxes axes = LevelAxesAt(37, -118);
  Pose pose;
  pose.position_ecef = ToEcef({37, -118, 1234});
  pose.ecef_from_body = glm::dmat3(axes.north, axes.east, -axes.up);
  pose.velocity_ecef_mps = 10.0 * axes.north;
  const glm::dvec3 normal = glm::normalize(axes.up - 0.3 * axes.north);
  const Pose standing = StandOn(pose, 900, normal);
  EXPECT_NEAR(ToGeodetic(standing.position_ecef).height_m, 900, 1e-6);
  EXPECT_NEAR(glm::dot(standing.ecef_from_body[2], normal), -1, 1e-12);
  EXPECT_NEAR(glm::dot(standing.ecef_from_body[0], axes.east), 0, 1e-12);
  EXPECT_GT(glm::dot(standing.ecef_from_body[0], axes.north), 0.9);
  EXPECT_NEAR(glm::dot(standing.velocity_ecef_mps, normal), 0, 1e-9);
  EXPECT_NEAR(glm::determinant(standing.ecef_from_body), 1, 1e-12);
}

TEST_F(ObjectSelectionTest, WhatADeadReckonedObjectMayHaveReachedIsConsidered) {
  const ViewMatrices matrices = MatricesOf(view_, 0, 5000);
  KinematicState state;
  state.position_ecef = ToEcef({37 - 3000 / 111'000.0, -118, 5000});  // 3 km behind the eye
  state.velocity_mps = {300, 0, 0};
  EXPECT_FALSE(MayBeSeen(matrices, state, 20, 0));
  EXPECT_FALSE(MayBeSeen(matrices, state, 20, 12));  // it stands still
  state.model = DeadReckoning::kFpw;
  EXPECT_FALSE(MayBeSeen(matrices, state, 20, 2));
  EXPECT_TRUE(MayBeSeen(matrices, state, 20, 12));
  state.position_ecef = ToEcef({37 + 3000 / 111'000.0, -118, 5000});
  EXPECT_TRUE(MayBeSeen(matrices, state, 20, 0));
}

TEST(ObjectSelection, ForcesDifferInColour) {
  EXPECT_NE(ForceColour(1), ForceColour(2));
  EXPECT_NE(ForceColour(2), ForceColour(3));
  EXPECT_EQ(ForceColour(0), ForceColour(200));
}

}  // namespace
}  // namespace belvedere

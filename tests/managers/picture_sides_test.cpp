#include "managers/picture_sides.h"

#include <gtest/gtest.h>

#include <array>

namespace belvedere {
namespace {

// In the frame of a page below the eye: the picture is what lies east of the eye's meridian.
class PictureSidesTest : public testing::Test {
 protected:
  PictureSidesTest() {
    page_.node = Quadcode::Containing(10, 20, 10);
    frame_ = FrameOf(page_.node);
    page_.center_ecef = frame_.origin_ecef;
    page_.radius_m = 1e4;
    node_.page = &page_;
    sight_.eye_ecef = frame_.ToEcef(glm::dvec3(0, 0, 1000));
    sight_.inwards_ecef[0] = frame_.ecef_from_frame * glm::dvec3(1, 0, 0);
  }
  PictureSides Sides() const { return {node_, sight_, frame_}; }

  TerrainPage page_;
  Frame frame_;
  CutNode node_;
  Sight sight_;
};

TEST_F(PictureSidesTest, ALongTriangleBesideThePictureIsToldByItsCorners) {
  const std::array<glm::vec3, 3> sliver{glm::vec3(-300, -4000, 0), glm::vec3(-300, 4000, 0), glm::vec3(-400, 0, 0)};
  const PictureSides sides = Sides();
  ASSERT_TRUE(sides.any());
  EXPECT_FALSE(sides.IsBeyond(sliver[2], 4001, 0)) << "the sphere around it reaches into the picture";
  EXPECT_TRUE(sides.AreBeyond(sliver, 0, 0));
  EXPECT_TRUE(sides.AreBeyond(sliver, 299, 0));
  EXPECT_FALSE(sides.AreBeyond(sliver, 301, 0)) << "what lies so far over or under it reaches into the picture";
  EXPECT_TRUE(sides.AreBeyond(sliver, 0, 0.05F));
  EXPECT_FALSE(sides.AreBeyond(sliver, 0, 0.1F)) << "its ends are 4 degrees beside the picture";
}

TEST_F(PictureSidesTest, WhatHasACornerInThePictureIsNotBeside) {
  const std::array<glm::vec3, 3> across{glm::vec3(-300, 0, 0), glm::vec3(-300, 400, 0), glm::vec3(5, 0, 0)};
  EXPECT_FALSE(Sides().AreBeyond(across, 0, 0));
}

}  // namespace
}  // namespace belvedere

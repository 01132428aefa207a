#include "dis/motion_rows.h"

#include <gtest/gtest.h>

#include <sstream>

namespace belvedere::dis {
namespace {

const std::string kHeader =
    "id,drm,name,x0,y0,z0,psi0_rad,theta0_rad,phi0_rad,vx,vy,vz,ax,ay,az,wx,wy,wz,dt_s,x1,source\r\n";

Result<std::vector<MotionRow>> Parse(const std::string& text) {
  std::istringstream stream(text);
  return ParseMotionRows(stream, "rows.csv");
}

TEST(MotionRows, ColumnsAreFoundByName) {
  const auto rows = Parse(kHeader + "a,4,RVW,1,2,3,0.1,0.2,0.3,4,5,6,7,8,9,10,11,12,0.5,99,\"a, b\"\r\n" +
                          "b,10,?,-1e3,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1,0,\n\n");
  ASSERT_TRUE(rows.ok()) << rows.message();
  ASSERT_EQ(rows->size(), 2u);
  const MotionRow& row = (*rows)[0];
  EXPECT_EQ(row.id, "a");
  EXPECT_EQ(row.state.model, DeadReckoning::kRvw);
  EXPECT_EQ(row.state.position_ecef, glm::dvec3(1, 2, 3));
  EXPECT_EQ(row.state.orientation.phi_rad, 0.3);
  EXPECT_EQ(row.state.velocity_mps, glm::dvec3(4, 5, 6));
  EXPECT_EQ(row.state.acceleration_mps2, glm::dvec3(7, 8, 9));
  EXPECT_EQ(row.state.angular_velocity_radps, glm::dvec3(10, 11, 12));
  EXPECT_EQ(row.dt_s, 0.5);
  EXPECT_EQ((*rows)[1].state.model, DeadReckoning::kStatic);
  EXPECT_EQ((*rows)[1].state.position_ecef.x, -1000.0);
}

TEST(MotionRows, WhatIsWrongIsNamed) {
  EXPECT_NE(Parse("id,drm\n").message().find("'x0'"), std::string::npos);
  EXPECT_FALSE(Parse("").ok());
  const auto bad = Parse(kHeader + "a,4,RVW,1,2,3,0.1,0.2,0.3,4,five,6,7,8,9,10,11,12,0.5,99,\n");
  EXPECT_NE(bad.message().find("rows.csv:2"), std::string::npos);
  EXPECT_NE(bad.message().find("'vy'"), std::string::npos);
  EXPECT_FALSE(Parse(kHeader + "a,4,RVW,nan,2,3,0.1,0.2,0.3,4,5,6,7,8,9,10,11,12,0.5,99,\n").ok());
  EXPECT_FALSE(Parse(kHeader + "a,4,RVW,1,2\n").ok());
}

}  // namespace
}  // namespace belvedere::dis

#include "managers/reach.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

TEST(Reach, QuadnodesTouchAlongBordersAndInCorners) {
  const Quadcode node = Quadcode::FromColumnRow(5, 100, 60);
  for (int east = -2; east <= 2; ++east) {
    for (int north = -2; north <= 2; ++north) {
      const Quadcode other = Quadcode::FromColumnRow(5, 100 + east, 60 + north);
      EXPECT_EQ(Touch(node, other), std::abs(east) <= 1 && std::abs(north) <= 1) << east << " " << north;
      EXPECT_EQ(Touch(other, node), Touch(node, other));
    }
  }
  const Quadcode diagonal = Quadcode::FromColumnRow(5, 101, 61);
  EXPECT_TRUE(Touch(node, diagonal.Child(0)));
  EXPECT_FALSE(Touch(node, diagonal.Child(3)));
  EXPECT_TRUE(Touch(node, node.Child(3).Child(0)));  // within
}

TEST(Reach, QuadnodesTouchOver180E) {
  const Quadcode west = Quadcode::FromColumnRow(3, 63, 10), east = Quadcode::FromColumnRow(3, 0, 10);
  EXPECT_TRUE(Touch(west, east));
  EXPECT_TRUE(Touch(east, west));
  EXPECT_FALSE(Touch(west, Quadcode::FromColumnRow(3, 1, 10)));
  EXPECT_TRUE(Touch(Quadcode::Root(7), Quadcode::Root(0)));
}

TEST(Reach, AllAtAPoleTouch) {
  const Quadcode there = Quadcode::FromColumnRow(4, 1, 63), opposite = Quadcode::FromColumnRow(6, 5, 255);
  EXPECT_TRUE(Touch(there, opposite));
  EXPECT_FALSE(Touch(there, Quadcode::FromColumnRow(6, 5, 254)));
  EXPECT_FALSE(Touch(there, Quadcode::FromColumnRow(6, 5, 0)));
  EXPECT_TRUE(Touch(Quadcode::FromColumnRow(4, 1, 0), Quadcode::FromColumnRow(6, 5, 0)));
}

TEST(Reach, WhereRowsChangeTheirWidthBothSidesTouch) {
  const Quadcode wide = Quadcode::Containing(67.51, 20, 5);
  const GeoBox box = wide.Box();
  for (const double longitude_deg :
       {box.west_deg, 0.5 * (box.west_deg + box.east_deg), box.east_deg - 0.01, box.west_deg - 0.01})
    EXPECT_TRUE(Touch(wide, Quadcode::Containing(67.49, longitude_deg, 5))) << longitude_deg;
  const Quadcode narrow = Quadcode::Containing(67.49, 20, 5);
  EXPECT_FALSE(Touch(wide, Quadcode::Containing(67.49, box.east_deg + 1.5 * narrow.WidthDegrees(), 5)));
}

TEST(Reach, AChangeReachesNeighboursAndThoseAskTheirs) {
  std::vector<Quadcode> row;
  for (int column = 0; column < 8; ++column) row.push_back(Quadcode::FromColumnRow(6, 100 + column, 60));
  std::vector<bool> is_new(8, false);
  is_new[0] = true;
  const Reach reach = ReachOf(row, is_new, {});
  EXPECT_EQ(reach.joined, (std::vector<bool>{true, true, false, false, false, false, false, false}));
  EXPECT_EQ(reach.asked, (std::vector<bool>{true, true, true, false, false, false, false, false}));
  const std::vector<Quadcode> gone{Quadcode::FromColumnRow(7, 2 * 106, 122)};
  const Reach left = ReachOf(row, std::vector<bool>(8, false), gone);
  EXPECT_EQ(left.joined, (std::vector<bool>{false, false, false, false, false, true, true, false}));
}

}  // namespace
}  // namespace belvedere

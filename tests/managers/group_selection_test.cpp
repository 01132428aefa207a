#include "managers/group_selection.h"

#include "managers/cluster_hierarchy.h"
#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

// Aircraft in rows, some metres from each other, about 37 N 118 W.
ObjectSnapshot Rows(int rows, double apart_m, uint8_t force = 3) {
  ObjectSnapshot snapshot;
  for (int i = 0; i < rows * rows; ++i) {
    ObjectRecord record;
    record.id = {1, 1, static_cast<uint16_t>(i + 1)};
    record.slot = static_cast<uint32_t>(i);
    record.incarnation = static_cast<uint32_t>(i + 1);
    record.type = {1, 2, 225, 57, 0, 0, 0};
    record.force = force;
    record.kinematics.position_ecef =
        ToEcef({37 + (i / rows - rows / 2) * apart_m / 111e3, -118 + (i % rows - rows / 2) * apart_m / 89e3, 9000});
    snapshot.objects.push_back(record);
  }
  return snapshot;
}

class GroupSelectionTest : public testing::Test {
 protected:
  void Look(double height_m) {
    view_.eye_ecef = ToEcef({37, -118, height_m});
    view_.ecef_from_camera = CameraAxes(37, -118, {}, Radians::FromDegrees(-90), {});
    matrices_ = MatricesOf(view_, 0, height_m);
  }
  void Select() { selection_.Select(tree_, view_, matrices_, 0); }
  uint32_t Grouped() const {
    uint32_t members = 0;
    for (const Cluster* group : selection_.groups()) members += group->members;
    return members;
  }
  ViewParameters view_;
  ViewMatrices matrices_;
  ClusterHierarchy hierarchy_;
  ClusterTree tree_;
  GroupSelection selection_;
};

TEST_F(GroupSelectionTest, TheTreeHoldsEveryObjectOnceAtEveryLevel) {
  const ObjectSnapshot snapshot = Rows(20, 700);
  tree_ = hierarchy_.Update(snapshot, 0, {}, {});
  ASSERT_EQ(tree_.levels.size(), static_cast<size_t>(kClusterLevels));
  for (const auto& level : tree_.levels) {
    uint32_t members = 0, leaf = 0;
    for (const Cluster& cluster : level) {
      members += cluster.members;
      EXPECT_EQ(cluster.first_leaf, leaf);
      leaf = cluster.end_leaf;
    }
    EXPECT_EQ(members, 400u);
    EXPECT_EQ(leaf, tree_.levels[0].size());
  }
  for (size_t l = 1; l < tree_.levels.size(); ++l) EXPECT_LE(tree_.levels[l].size(), tree_.levels[l - 1].size());
  for (const ObjectRecord& record : snapshot.objects) {
    const uint32_t leaf = tree_.LeafOf(record.slot, record.incarnation);
    ASSERT_LT(leaf, tree_.levels[0].size());
    const Cluster& cluster = tree_.levels[0][leaf];
    EXPECT_LE(glm::distance(cluster.centre_ecef, record.kinematics.position_ecef), cluster.radius_m + 1e-3);
  }
  EXPECT_EQ(tree_.LeafOf(3, 77), ClusterTree::kNone);  // another object in that slot
}

TEST_F(GroupSelectionTest, ManyFarAwayAreFewSymbolsAndNearByTheyAreThemselves) {
  tree_ = hierarchy_.Update(Rows(20, 700), 0, {}, {});
  Look(2e6);
  Select();
  EXPECT_EQ(Grouped(), 400u);
  EXPECT_LT(selection_.groups().size(), 10u);
  for (uint32_t leaf = 0; leaf < tree_.levels[0].size(); ++leaf) {
    EXPECT_EQ(selection_.StateOf(leaf), GroupSelection::State::kGrouped);
  }
  Look(12'000);
  Select();
  EXPECT_LT(Grouped(), 40u);
}

TEST_F(GroupSelectionTest, FewAreNeverGrouped) {
  tree_ = hierarchy_.Update(Rows(10, 700), 0, {}, {});
  Look(2e6);
  Select();
  EXPECT_TRUE(selection_.groups().empty());
}

TEST_F(GroupSelectionTest, ImportantOnesKeepFinerDetail) {
  const ImportanceTable table(
      {{{{ImportanceInput::kOpposing, 0.5, 1, 1, 2}}, 1.0}, {{{ImportanceInput::kNeutral, 0.5, 1, 1, 2}}, 0.0}});
  const auto groups_of = [&](uint8_t force) {
    ClusterHierarchy hierarchy;
    tree_ = hierarchy.Update(Rows(20, 700, force), 0, table, {});
    selection_ = {};
    Look(150'000);
    Select();
    return selection_.groups().size();
  };
  const size_t neutral = groups_of(3);
  EXPECT_GT(groups_of(2), 2 * neutral);
}

TEST_F(GroupSelectionTest, WhatIsBehindTheEarthIsNotLookedInto) {
  tree_ = hierarchy_.Update(Rows(20, 700), 0, {}, {});
  view_.eye_ecef = ToEcef({-37, 62, 1e6});
  view_.ecef_from_camera = CameraAxes(-37, 62, {}, Radians::FromDegrees(-90), {});
  matrices_ = MatricesOf(view_, 0, 1e6);
  Select();
  EXPECT_EQ(selection_.StateOf(0), GroupSelection::State::kHidden);
  EXPECT_TRUE(selection_.groups().empty());
}

TEST_F(GroupSelectionTest, GroupsDoNotFlickerWhereTheEyeGoesToAndFro) {
  tree_ = hierarchy_.Update(Rows(20, 700), 0, {}, {});
  Look(200'000);
  Select();
  const size_t before = selection_.groups().size();
  for (int i = 0; i < 20; ++i) {
    Look(i % 2 == 0 ? 206'000 : 200'000);
    Select();
    EXPECT_EQ(selection_.groups().size(), before);
  }
}

TEST_F(GroupSelectionTest, SymbolsAreBounded) {
  tree_ = hierarchy_.Update(Rows(100, 12'000), 0, {}, {});
  Look(3e6);
  Select();
  EXPECT_LE(selection_.groups().size(), kMostSymbols);
  EXPECT_GT(Grouped(), 9000u);
}

}  // namespace
}  // namespace belvedere

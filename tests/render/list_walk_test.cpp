#include "render/list_walk.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

using Kind = ListRecord::Kind;

// Looks straight down on (0 N, 0 E) from 100 km.
ViewMatrices Above() {
  ViewParameters view;
  view.eye_ecef = ToEcef({0, 0, 100e3});
  view.ecef_from_camera = CameraAxes(0, 0, Radians{}, Radians::FromDegrees(-90), Radians{});
  return MatricesOf(view, 0, 100e3);
}
BoundingSphere Ball(double latitude_deg, double longitude_deg, double radius_m) {
  return {ToEcef({latitude_deg, longitude_deg, 0}), radius_m};
}

class ListWalk : public ::testing::Test {
 protected:
  void Begin(const BoundingSphere& volume) {
    list_.volumes.push_back(volume);
    open_.push_back(list_.records.size());
    list_.records.push_back({Kind::kCullBegin, static_cast<uint32_t>(list_.volumes.size() - 1), 0, 0});
  }
  void End() {
    list_.records.push_back({Kind::kCullEnd, 0, 0, 0});
    list_.records[open_.back()].skip = static_cast<uint32_t>(list_.records.size());
    open_.pop_back();
  }
  void Terrain(uint32_t triangles) {
    list_.terrain_draws.emplace_back().index_count = 3 * triangles;
    list_.records.push_back({Kind::kDrawTerrain, static_cast<uint32_t>(list_.terrain_draws.size() - 1), 1, 0});
  }
  const VisibleDraws& Walk() {
    WalkList(list_, Above(), visible_);
    return visible_;
  }

  DisplayList list_;
  VisibleDraws visible_;
  std::vector<size_t> open_;
};

TEST_F(ListWalk, SkipsWhatTheFrustumHides) {
  Begin(Ball(0, 0, 1000));
  Terrain(10);
  End();
  Begin(Ball(3, 0, 1000));  // 330 km north: outside 60 degrees of view
  Terrain(20);
  Begin(Ball(0, 0, 1000));  // within a hidden volume: not looked at
  Terrain(30);
  End();
  End();
  Begin(Ball(0.1, 0, 1000));
  Terrain(40);
  End();
  EXPECT_EQ(Walk().terrain, (std::vector<uint32_t>{0, 3}));
  EXPECT_EQ(visible_.triangles, 50U);
}

TEST_F(ListWalk, SkipsWhatTheEarthHides) {
  Begin(Ball(0, 180, 1000));  // straight ahead, behind the whole Earth
  Terrain(1);
  End();
  EXPECT_TRUE(Walk().terrain.empty());
}

// Within an enclosed volume the frustum is not asked again, so that even a wrong volume is drawn; after it, it is.
TEST_F(ListWalk, AnEnclosedVolumeTurnsTheFrustumTestOffForItsChildren) {
  Begin(Ball(0, 0, 1000));
  Begin(Ball(3, 0, 1000));
  Terrain(1);
  End();
  End();
  Begin(Ball(3, 0, 1000));
  Terrain(2);
  End();
  EXPECT_EQ(Walk().terrain, (std::vector<uint32_t>{0}));
}

TEST_F(ListWalk, TheHorizonIsTestedEvenWithinAnEnclosedVolume) {
  Begin(Ball(0, 0, 1000));
  Begin(Ball(0, 180, 1000));
  Terrain(1);
  End();
  End();
  EXPECT_TRUE(Walk().terrain.empty());
}

TEST_F(ListWalk, CollectsRangesOfInstances) {
  list_.instances.resize(9);
  list_.records.push_back({Kind::kDrawInstances, 2, 5, 0});
  EXPECT_EQ(Walk().instances, (std::vector<InstanceRange>{{2, 5}}));
}

TEST_F(ListWalk, AnEmptyListShowsNothing) {
  EXPECT_TRUE(Walk().terrain.empty());
  EXPECT_EQ(visible_.triangles, 0U);
}

}  // namespace
}  // namespace belvedere

#include "managers/object_manager.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/model_catalogue.h"
#include "servers/model_reader.h"
#include "tests/servers/terrain_test_pages.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <string>
#include <thread>
#include <vector>

namespace belvedere {
namespace {

constexpr DataType kModels = 1;
constexpr EntityType kFighter{1, 2, 225, 1, 1, 0, 0}, kMissile{2, 1, 225, 1, 1, 0, 0};

// Lists of a running manager; every model that it wishes for is read, and on the GPU, at once.
class ObjectManagerTest : public testing::Test {
 protected:
  ObjectManagerTest() {
    ViewParameters view;
    view.view = 1;
    view.number = 1;
    view.eye_ecef = ToEcef({20, 30, 5100});
    view.ecef_from_camera = CameraAxes(20, 30, {}, Radians::FromDegrees(-90), {});
    view.effects = false;
    channel_->parameters.Publish(view);
  }

  static LayerTable Layers() {
    LayerTable layers;
    layers.Add({"terrain", PageKind::kTerrain, 0, 0, [](Quadcode) { return false; }});
    layers.Add({"models", PageKind::kModel, 0, 0, [](Quadcode) { return true; }});
    return layers;
  }

  // A list with all that the view wants.
  const DisplayList& SettledList() {
    TripleBuffer<DisplayList>& lists = channel_->object_lists;
    while (true) {
      while (!lists.Fetch()) std::this_thread::yield();
      if (!lists.front().instances.empty() && lists.front().statistics.settled) return lists.front();
      Serve(lists.front());
    }
  }

  void Serve(const DisplayList& list) {
    while (const std::optional<PageKey> key = paging_.queue(kModels).TryTake()) {
      auto page = ReadModel(catalogue_, ModelCatalogue::ModelNumber(key->node));
      ASSERT_TRUE(page.ok()) << page.message();
      kept_.push_back(paging_.cache.Insert(*key, std::move(*page)));
      paging_.queue(kModels).Done(*key);
    }
    for (const PagePin& upload : list.uploads) {
      Residency& residency = *upload.page().residency();
      if (!residency.on_gpu()) residency.Place(ModelCatalogue::ModelNumber(upload.key().node));
    }
  }

  ObjectRecord Fighter() const {
    ObjectRecord record;
    record.id = {1, 2, 3};
    record.type = kFighter;
    record.kinematics.position_ecef = ToEcef({20, 30, 5000});
    return record;
  }

  const ModelCatalogue catalogue_{std::string(BELVEDERE_SOURCE_DIR) + "/servers/models",
                                  {{"fighter", 15.6F}, {"missile", 3.7F}}};
  const EntityLooks looks_{{{*EntityPattern::Parse("1.2"), {0, SymbolShape::kAir, "fighter"}},
                            {*EntityPattern::Parse("2"), {1, SymbolShape::kOther, "missile"}}}};
  Paging paging_{Layers(), size_t{1} << 30, Clock::System()};
  ObjectTable objects_;
  ClusterManager clusters_{objects_, {}, Clock::System()};
  std::shared_ptr<ViewChannel> channel_ = std::make_shared<ViewChannel>();
  std::vector<PagePin> kept_;
};

TEST_F(ObjectManagerTest, WhatHangsOnAnObjectIsDrawnAtItsStations) {
  ObjectRecord fighter = Fighter();
  fighter.attached_array = {{{640, kMissile}, {768, kMissile}, {900, kMissile}, {512, {2, 0, 0, 0, 0, 0, 0}}}};
  fighter.attached_count = 4;
  objects_.Put(fighter);
  objects_.Tick(1.0);
  ObjectManager manager(1, paging_, looks_, objects_, clusters_, channel_, Clock::System());
  const DisplayList& list = SettledList();
  ASSERT_EQ(list.instances.size(), 4U);  // no such station: 900
  std::vector<glm::dvec3> places;
  const ObjectInstance* carrier = nullptr;
  for (const ObjectInstance& instance : list.instances) {
    if (instance.look.model_slot == 0) carrier = &instance;
  }
  ASSERT_NE(carrier, nullptr);
  for (const ObjectInstance& instance : list.instances) {
    if (&instance == carrier) continue;
    EXPECT_EQ(instance.look.model_slot, 1);
    EXPECT_EQ(instance.label, 0U);
    EXPECT_EQ(instance.object, carrier->object);
    EXPECT_EQ(instance.ecef_from_body, carrier->ecef_from_body);
    places.push_back(glm::transpose(carrier->ecef_from_body) * (instance.position_ecef - carrier->position_ecef));
  }
  EXPECT_NEAR(places[0].y, -2.1, 0.02);  // under the left wing
  EXPECT_NEAR(places[1].y, 2.1, 0.02);   // under the right
  EXPECT_NEAR(places[2].y, 0, 0.02);
  for (const glm::dvec3& place : places) EXPECT_GT(place.z, 0.3);
}

TEST_F(ObjectManagerTest, WhatHangsTurnsWithItsCarrier) {
  ObjectRecord fighter = Fighter();
  fighter.kinematics.model = DeadReckoning::kRpw;
  fighter.kinematics.angular_velocity_radps = {1, 0, 0};  // rolls right: the left wing rises
  fighter.attached_array[0] = {640, kMissile};
  fighter.attached_count = 1;
  objects_.Put(fighter);
  objects_.Tick(1.0);
  ObjectManager manager(1, paging_, looks_, objects_, clusters_, channel_, Clock::System());
  const DisplayList& list = SettledList();
  ASSERT_EQ(list.instances.size(), 2U);
  const ObjectInstance& missile = list.instances[0].look.model_slot == 1 ? list.instances[0] : list.instances[1];
  const glm::dvec3 in_body = glm::transpose(missile.ecef_from_body) * missile.velocity_mps;
  EXPECT_NEAR(in_body.z, -2.1, 0.02);
  EXPECT_NEAR(in_body.x, 0, 1e-6);
}

TEST_F(ObjectManagerTest, WatchAreasAreOutlinedWithoutObjectsToo) {
  ViewParameters view = *channel_->parameters.Get();
  view.watched = std::make_shared<const std::vector<WatchArea>>(1, WatchArea{ToEcef({20, 30, 0}), 300});
  channel_->parameters.Publish(view);
  ObjectManager manager(1, paging_, looks_, objects_, clusters_, channel_, Clock::System());
  while (!channel_->object_lists.Fetch()) std::this_thread::yield();
  EXPECT_EQ(channel_->object_lists.front().effects.size(), 64U);
  view.number = 2;
  view.watched = nullptr;
  channel_->parameters.Publish(view);
  while (!channel_->object_lists.Fetch() || channel_->object_lists.front().view_number != 2) std::this_thread::yield();
  EXPECT_TRUE(channel_->object_lists.front().effects.empty());
}

}  // namespace
}  // namespace belvedere

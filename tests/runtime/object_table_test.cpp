#include "runtime/scene/object_table.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string_view>
#include <thread>

namespace belvedere {
namespace {

constexpr std::string_view kEscape = "\x1b[31m%s%n";

ObjectRecord Record(uint16_t entity, double time_s) {
  ObjectRecord record;
  record.id = {1, 2, entity};
  record.type = {1, 2, 225, 57, 1, 0, 0};
  record.kinematics.position_ecef = {6378137.0 + 5000, 0, 0};
  record.kinematics.velocity_mps = {0, 200, 0};
  record.kinematics.model = DeadReckoning::kFpw;
  record.kinematics.time_s = time_s;
  record.received_s = time_s;
  return record;
}

TEST(EntityId, TextAndBack) {
  const EntityId id{1, 65535, 42};
  EXPECT_EQ(id.ToString(), "1:65535:42");
  EXPECT_EQ(EntityId::Parse("1:65535:42"), id);
  for (const char* bad : {"", "1:2", "1:2:", "1:2:3:4", "1:2:65536", "a:b:c", "1:2:3 ", "-1:2:3"}) {
    EXPECT_FALSE(EntityId::Parse(bad)) << bad;
  }
}

TEST(EntityType, Text) {
  EXPECT_EQ((EntityType{1, 2, 225, 1, 1, 3, 0}.ToString()), "1.2.225.1.1.3.0");
}

TEST(Marking, OnlyPrintableCharactersAreKept) {
  EXPECT_EQ(Marking::Sanitise(std::string_view("UAL123  ")).view(), "UAL123");
  EXPECT_EQ(Marking::Sanitise(kEscape).view(), "?[31m%s%n");
  EXPECT_EQ(Marking::Sanitise(std::string_view("AB\0CD", 5)).view(), "AB");
  EXPECT_EQ(Marking::Sanitise(std::string_view("\xff\x7f\x80")).view(), "???");
  EXPECT_EQ(Marking::Sanitise(std::string_view("12345678901234")).view(), "12345678901");
  EXPECT_TRUE(Marking::Sanitise(std::string_view("   ")).empty());
}

TEST(ObjectTable, ASnapshotHoldsWhatWasPutInOrderOfId) {
  ObjectTable table;
  EXPECT_TRUE(table.Snapshot()->objects.empty());
  for (const uint16_t entity : {uint16_t{7}, uint16_t{3}, uint16_t{9}}) table.Put(Record(entity, 1.0));
  table.Tick(1.0);
  const auto snapshot = table.Snapshot();
  ASSERT_EQ(snapshot->objects.size(), 3u);
  EXPECT_EQ(snapshot->objects[0].id.entity, 3);
  EXPECT_EQ(snapshot->objects[2].id.entity, 9);
  ASSERT_NE(snapshot->Find({1, 2, 7}), nullptr);
  EXPECT_EQ(snapshot->Find({1, 2, 7})->kinematics.velocity_mps.y, 200.0);
  EXPECT_EQ(snapshot->Find({1, 2, 8}), nullptr);
  EXPECT_EQ(snapshot->Find({9, 9, 9}), nullptr);
}

TEST(ObjectTable, SnapshotsAreImmutableAndNotRebuiltTooOften) {
  ObjectTable table;
  table.Put(Record(1, 1.0));
  table.Tick(1.0);
  const auto first = table.Snapshot();
  table.Put(Record(2, 1.01));
  table.Tick(1.01);
  EXPECT_EQ(table.Snapshot(), first);
  ASSERT_TRUE(table.NextTick());
  EXPECT_NEAR(*table.NextTick(), 1.05, 1e-9);
  table.Tick(*table.NextTick());
  EXPECT_EQ(first->objects.size(), 1u);
  EXPECT_EQ(table.Snapshot()->objects.size(), 2u);
  EXPECT_GT(table.Snapshot()->number, first->number);
  EXPECT_NEAR(*table.NextTick(), 13.0, 1e-9);  // then only the time-out of the stalest is left to do
}

TEST(ObjectTable, ReportsAreCounted) {
  ObjectTable table;
  table.Put(Record(1, 1.0));
  table.Tick(1.0);
  const uint32_t first = table.Snapshot()->objects[0].report;
  table.Put(Record(1, 2.0));
  table.Tick(2.0);
  EXPECT_EQ(table.Snapshot()->objects[0].report, first + 1);
}

TEST(ObjectTable, AStateOutOfOrderIsNotTaken) {
  ObjectTable table;
  table.Put(Record(1, 5.0));
  ObjectRecord late = Record(1, 4.9);
  late.received_s = 5.01;
  table.Put(late);
  table.Tick(5.1);
  EXPECT_EQ(table.Snapshot()->objects[0].kinematics.time_s, 5.0);
  EXPECT_EQ(table.Snapshot()->objects[0].received_s, 5.01);
  EXPECT_EQ(table.Counters().out_of_order, 1u);
  table.Put(Record(1, 1.0));  // much older: the sender set its clock back
  table.Tick(6.0);
  EXPECT_EQ(table.Snapshot()->objects[0].kinematics.time_s, 1.0);
}

TEST(ObjectTable, SilentObjectsTimeOut) {
  ObjectTable table;
  table.Put(Record(1, 0.0));
  table.Put(Record(2, 5.0));
  table.Tick(11.9);
  EXPECT_EQ(table.Snapshot()->objects.size(), 2u);
  table.Tick(12.0);
  ASSERT_EQ(table.Snapshot()->objects.size(), 1u);
  EXPECT_EQ(table.Snapshot()->objects[0].id.entity, 2);
  table.Tick(17.0);
  EXPECT_TRUE(table.Snapshot()->objects.empty());
  EXPECT_EQ(table.Counters().timed_out, 2u);
  EXPECT_FALSE(table.NextTick());
}

TEST(ObjectTable, ARuleMaySayHowLongAnObjectMayBeSilent) {
  ObjectTableOptions options;
  options.timeouts = {{.types = *EntityPattern::Parse("1.2"), .version = {}, .stationary = {}, .timeout_s = 5},
                      {.types = {}, .version = uint8_t{7}, .stationary = true, .timeout_s = 144}};
  ObjectTable table(options);
  const auto put = [&](uint16_t entity, uint8_t domain, uint8_t version, double speed_mps) {
    ObjectRecord record;
    record.id = {1, 1, entity};
    record.type = {1, domain, 0, 0, 0, 0, 0};
    record.protocol_version = version;
    record.kinematics.position_ecef = {6.4e6, 0, 0};
    record.kinematics.velocity_mps = {speed_mps, 0, 0};
    record.kinematics.model = DeadReckoning::kFpw;
    table.Put(record);
  };
  put(1, 2, 7, 0);  // air
  put(2, 1, 7, 0);  // standing, version 7
  put(3, 1, 6, 0);  // standing, version 6
  put(4, 1, 7, 9);  // moving
  table.Tick(5.0);
  EXPECT_EQ(table.Ids().size(), 3u);
  EXPECT_EQ(table.NextTick(), 12.0);
  table.Tick(12.0);
  EXPECT_EQ(table.Ids(), (std::vector<EntityId>{{1, 1, 2}}));
  table.Tick(143.9);
  EXPECT_EQ(table.NextTick(), 144.0);
  table.Tick(144.0);
  EXPECT_TRUE(table.Ids().empty());
}

TEST(ObjectTable, AtCapacityTheStalestGoesWhateverItsRule) {
  ObjectTableOptions options;
  options.capacity = 2;
  ObjectTable table(options);
  for (uint16_t entity = 1; entity <= 3; ++entity) {
    ObjectRecord record;
    record.id = {1, 1, entity};
    record.kinematics.position_ecef = {6.4e6, 0, 0};
    record.kinematics.velocity_mps = {entity == 1 ? 0.0 : 10.0, 0, 0};  // the first may be silent for longer
    record.kinematics.model = DeadReckoning::kFpw;
    record.received_s = entity;
    table.Put(record);
  }
  EXPECT_EQ(table.Ids(), (std::vector<EntityId>{{1, 1, 2}, {1, 1, 3}}));
}

TEST(ObjectTable, EventsAreBoundedAndEnd) {
  ObjectTable table;
  for (size_t i = 0; i < kMostSceneEvents + 10; ++i) table.AddEvent({.end_s = i % 2 == 0 ? 1.0 : 9.0});
  table.Tick(0.5);
  const auto all = table.Snapshot();
  EXPECT_EQ(all->events.size(), kMostSceneEvents);
  EXPECT_EQ(all->events.front().number, 11u);
  table.AddEvent({.end_s = 9.0});
  table.Tick(2.0);
  EXPECT_EQ(table.Snapshot()->events.size(), kMostSceneEvents / 2 + 1);
}

TEST(ObjectTable, RemovedAndDeactivatedObjectsGo) {
  ObjectTable table;
  table.Put(Record(1, 0.0));
  table.Put(Record(2, 0.0));
  table.Put(Record(3, 0.0));
  EXPECT_TRUE(table.Remove({1, 2, 1}));
  EXPECT_FALSE(table.Remove({1, 2, 1}));
  ObjectRecord gone = Record(2, 1.0);
  gone.appearance = kAppearanceDeactivated;
  table.Put(gone);
  gone.id.entity = 77;
  table.Put(gone);  // never known: not added
  ObjectChange change;
  change.appearance = kAppearanceDeactivated;
  EXPECT_TRUE(table.Change({1, 2, 3}, change, 1.0));
  table.Tick(1.0);
  EXPECT_TRUE(table.Snapshot()->objects.empty());
  EXPECT_EQ(table.Counters().removed, 3u);
}

TEST(ObjectTable, AChangeKeepsTypeAndModel) {
  ObjectTable table;
  ObjectChange change;
  change.position_ecef = {6378137.0 + 6000, 0, 0};
  change.velocity_mps = {1, 2, 3};
  change.time_s = 1.0;
  EXPECT_FALSE(table.Change({1, 2, 1}, change, 1.0));
  table.Put(Record(1, 0.0));
  EXPECT_TRUE(table.Change({1, 2, 1}, change, 1.0));
  table.Tick(1.0);
  const ObjectRecord record = table.Snapshot()->objects.at(0);
  EXPECT_EQ(record.kinematics.velocity_mps, change.velocity_mps);
  EXPECT_EQ(record.kinematics.model, DeadReckoning::kFpw);
  EXPECT_EQ(record.type.category, 57);
}

TEST(ObjectTable, AtCapacityTheStalestGoesFirst) {
  ObjectTable table({.capacity = 3});
  for (uint16_t entity = 1; entity <= 3; ++entity) table.Put(Record(entity, entity));
  table.Put(Record(1, 4.0));  // heard of again: 2 is the stalest now
  table.Put(Record(4, 5.0));
  table.Tick(5.0);
  const auto snapshot = table.Snapshot();
  ASSERT_EQ(snapshot->objects.size(), 3u);
  EXPECT_EQ(snapshot->Find({1, 2, 2}), nullptr);
  EXPECT_NE(snapshot->Find({1, 2, 1}), nullptr);
  EXPECT_EQ(table.Counters().crowded_out, 1u);
  EXPECT_EQ(table.Counters().most_alive, 3u);
}

TEST(ObjectTable, NonsenseIsFlagged) {
  ObjectTable table;
  const auto flags = [&](ObjectRecord record) {
    table.Put(record);
    table.Tick(record.received_s);
    return table.Snapshot()->Find(record.id)->flags;
  };
  ObjectRecord record = Record(1, 1.0);
  EXPECT_EQ(flags(record), 0);
  record = Record(2, 2.0);
  record.kinematics.position_ecef = {0, 0, 0};
  EXPECT_EQ(flags(record), kObjectAtEarthCentre);
  record = Record(3, 3.0);
  record.kinematics.position_ecef = {100e3, 0, 0};
  EXPECT_EQ(flags(record), kObjectUnderground);
  record = Record(4, 4.0);
  record.kinematics.position_ecef = {0, 0, 6356752.3 - 11e3};  // the deepest sea, at a pole
  EXPECT_EQ(flags(record), 0);
  record = Record(5, 5.0);
  record.kinematics.position_ecef = {1e15, 1e15, 0};
  EXPECT_EQ(flags(record), kObjectTooFar);
  EXPECT_FALSE(table.Snapshot()->Find(record.id)->visible());
  record = Record(6, 6.0);
  record.kinematics.velocity_mps = {3e38, 0, 0};
  EXPECT_EQ(flags(record), kObjectMotionClamped);
  EXPECT_NEAR(table.Snapshot()->Find(record.id)->kinematics.velocity_mps.x, kMaxSpeed_mps, 1e-6);
  record = Record(7, 7.0);
  record.appearance = kAppearanceFrozen;
  EXPECT_EQ(flags(record), kObjectFrozen);
  EXPECT_EQ(table.Snapshot()->Find(record.id)->kinematics.model, DeadReckoning::kStatic);
}

TEST(ObjectTable, ReadersSeeWholeSnapshotsWhileWritersWrite) {
  ObjectTable table({.publish_interval_s = 0.0});
  std::atomic<bool> done = false;
  std::thread reader([&] {
    uint64_t last = 0;
    while (!done) {
      const auto snapshot = table.Snapshot();
      ASSERT_GE(snapshot->number, last);
      last = snapshot->number;
      for (const ObjectRecord& record : snapshot->objects) {
        ASSERT_EQ(record.kinematics.velocity_mps.x, record.kinematics.velocity_mps.z);
      }
    }
  });
  for (int i = 0; i < 20000; ++i) {
    ObjectRecord record = Record(static_cast<uint16_t>(i % 50), i * 1e-3);
    record.kinematics.velocity_mps = glm::dvec3(i);
    table.Put(record);
    table.Tick(i * 1e-3);
  }
  done = true;
  reader.join();
  EXPECT_EQ(table.Counters().alive, 50u);
}

}  // namespace
}  // namespace belvedere

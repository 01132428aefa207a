#include "dis/intake.h"

#include "dis/timestamp.h"
#include "tests/dis/fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

namespace belvedere::dis {
namespace {

class IntakeTest : public testing::Test {
 protected:
  void Take(std::span<const uint8_t> datagram) {
    const double since_s = 0.1 * ticks_;
    intake_.Take(datagram, {10.0 + since_s, 1000.0 + since_s, {}});
  }
  std::shared_ptr<const ObjectSnapshot> Snapshot() {
    table_.Tick(10.0 + 0.1 * ++ticks_);
    return table_.Snapshot();
  }
  const IntakeCounters& counters() const { return intake_.counters(); }

  ObjectTable table_;
  Intake intake_{table_, {.exercise = uint8_t{1}}};
  int ticks_ = 0;
};

TEST_F(IntakeTest, AnEntityStateBecomesARecord) {
  Take(Encoded(SomeEntity()));
  const auto snapshot = Snapshot();
  ASSERT_EQ(snapshot->objects.size(), 1u);
  const ObjectRecord& record = snapshot->objects[0];
  EXPECT_EQ(record.id, SomeEntity().id);
  EXPECT_EQ(record.marking.view(), "UAL123");
  EXPECT_EQ(record.kinematics.model, DeadReckoning::kRvw);
  EXPECT_EQ(record.kinematics.position_ecef, SomeEntity().position_ecef);
  EXPECT_EQ(record.kinematics.time_s, 10.0);
  EXPECT_EQ(record.damage(), 3u);
  EXPECT_TRUE(record.visible());
}

TEST_F(IntakeTest, EveryPduIsCountedOnce) {
  std::vector<uint8_t> bundle = Encoded(SomeEntity());
  const auto append = [&](const std::vector<uint8_t>& more) { bundle.insert(bundle.end(), more.begin(), more.end()); };
  std::vector<uint8_t> attributes = Encoded(SomeEntity());
  attributes[2] = 72;
  append(attributes);
  append(Encoded(SomeEntity(0)));
  append(Encoded(SomeEntity(), {.exercise = 2}));
  append(Encoded(SomeEntity(), {.version = 8}));
  Take(bundle);
  EXPECT_EQ(counters().datagrams, 1u);
  EXPECT_EQ(counters().received, 5u);
  EXPECT_EQ(counters().accepted, 1u);
  EXPECT_EQ(counters().ignored_type[72], 1u);
  EXPECT_EQ(counters().rejected[static_cast<size_t>(Rejection::kBadEntityId)], 1u);
  EXPECT_EQ(counters().filtered, 1u);
  EXPECT_EQ(counters().ignored_version, 1u);
  EXPECT_EQ(counters().received,
            counters().accepted + counters().rejected_total() + counters().ignored_total() + counters().filtered);
}

TEST_F(IntakeTest, RemoveEntityTakesOutOneOrAll) {
  for (uint16_t entity = 1; entity <= 3; ++entity) Take(Encoded(SomeEntity(entity)));
  std::vector<uint8_t> bytes(PduTraits<RemoveEntity>::kFixedBytes);
  EncodePdu({}, RemoveEntity{{}, {1, 3001, 2}, 0}, bytes);
  Take(bytes);
  EXPECT_EQ(Snapshot()->objects.size(), 2u);
  EncodePdu({}, RemoveEntity{{}, {2, 0xFFFF, 0xFFFF}, 0}, bytes);
  Take(bytes);
  EXPECT_EQ(Snapshot()->objects.size(), 2u);
  EncodePdu({}, RemoveEntity{{}, {1, 0xFFFF, 0xFFFF}, 0}, bytes);
  Take(bytes);
  EXPECT_TRUE(Snapshot()->objects.empty());
}

UdpAddress Host(uint8_t last) {
  return {.bytes = {10, 0, 0, last}, .port = 3000};
}

TEST_F(IntakeTest, StopHoldsAnEntityUntilItIsStartedOrReportedAgain) {
  EntityState state = SomeEntity();
  state.model = 2;
  Take(Encoded(state));
  std::vector<uint8_t> bytes(64);
  const size_t stop = EncodePdu({}, StopFreeze{{}, {0xFFFF, 0xFFFF, 0xFFFF}, {}, 0, 0, 1}, bytes);
  intake_.Take(std::span(bytes).first(stop), {14.0, 1004.0, {}});
  table_.Tick(14.1);
  const ObjectRecord held = table_.Snapshot()->objects.at(0);
  const glm::dvec3 expected = state.position_ecef + 4.0 * glm::dvec3(state.velocity_mps);
  EXPECT_LT(glm::distance(PoseAt(held.kinematics, 20.0).position_ecef, expected), 1e-6);
  EXPECT_NE(held.flags & kObjectFrozen, 0);
  const size_t start = EncodePdu({}, StartResume{{}, state.id, {}, {}, 2}, bytes);
  intake_.Take(std::span(bytes).first(start), {20.0, 1010.0, {}});
  table_.Tick(20.1);
  const ObjectRecord going = table_.Snapshot()->objects.at(0);
  EXPECT_EQ(going.flags & kObjectFrozen, 0);
  EXPECT_LT(glm::distance(PoseAt(going.kinematics, 20.0).position_ecef, expected), 1e-6);
  EXPECT_NE(going.report, held.report);
}

TEST(IntakeAdmission, CommandsOfStrangersAndPlacesThatCannotBeShownAreRefused) {
  ObjectTable table;
  AdmissionOptions admission;
  admission.refuse_strangers = admission.refuse_absurd = true;
  admission.managers = *ParseAddressRanges(std::vector<std::string>{"10.0.0.9"});
  Intake intake(table, {.exercise = {}, .admission = admission});
  intake.Take(Encoded(SomeEntity(1)), {1.0, 0.0, Host(1)});
  intake.Take(Encoded(SomeEntity(2)), {1.0, 0.0, Host(2)});
  std::vector<uint8_t> remove(28);
  EncodePdu({}, RemoveEntity{{}, {0xFFFF, 0xFFFF, 0xFFFF}, 0}, remove);
  intake.Take(remove, {1.1, 0.1, Host(1)});  // its own goes, the other's stays
  EXPECT_EQ(table.Ids(), std::vector<EntityId>{SomeEntity(2).id});
  EXPECT_EQ(intake.counters().refused[static_cast<size_t>(Refusal::kStranger)], 1u);
  intake.Take(remove, {1.2, 0.2, Host(9)});
  EXPECT_TRUE(table.Ids().empty());
  EntityState nowhere = SomeEntity(3);
  nowhere.position_ecef = {};
  intake.Take(Encoded(nowhere), {1.3, 0.3, Host(1)});
  EXPECT_TRUE(table.Ids().empty());
  const IntakeCounters& c = intake.counters();
  EXPECT_EQ(c.refused[static_cast<size_t>(Refusal::kAbsurd)], 1u);
  EXPECT_EQ(c.received, c.accepted + c.refused_total());
}

TEST(IntakeAdmission, SourcesAndRatesAreLimited) {
  ObjectTable table;
  AdmissionOptions admission;
  admission.sources = *ParseAddressRanges(std::vector<std::string>{"10.0.0.0/30"});
  admission.pdus_per_s = 10;
  admission.new_entities_per_s = 2;
  Intake intake(table, {.exercise = {}, .admission = admission});
  intake.Take(Encoded(SomeEntity(1)), {1.0, 0.0, Host(4)});
  EXPECT_EQ(intake.counters().refused[static_cast<size_t>(Refusal::kSource)], 1u);
  EXPECT_EQ(intake.counters().received, 0u);
  for (uint16_t entity = 1; entity <= 5; ++entity) intake.Take(Encoded(SomeEntity(entity)), {1.0, 0.0, Host(1)});
  EXPECT_EQ(table.Ids().size(), 2u);
  EXPECT_EQ(intake.counters().refused[static_cast<size_t>(Refusal::kNewEntity)], 3u);
  for (int i = 0; i < 10; ++i) intake.Take(Encoded(SomeEntity(1)), {1.0, 0.0, Host(1)});
  EXPECT_EQ(intake.counters().refused[static_cast<size_t>(Refusal::kRate)], 5u);  // of 15
  intake.Take(Encoded(SomeEntity(3)), {1.0, 0.0, Host(2)});                       // another host has its own rate
  EXPECT_EQ(table.Ids().size(), 3u);
  intake.Take(Encoded(SomeEntity(4)), {1.6, 0.0, Host(1)});
  EXPECT_EQ(table.Ids().size(), 4u);
}

TEST(AddressRange, HoldsWhatItSays) {
  EXPECT_TRUE(AddressRange::Parse("10.0.0.0/8")->Contains(Host(200)));
  EXPECT_FALSE(AddressRange::Parse("10.0.0.0/25")->Contains(Host(200)));
  EXPECT_TRUE(AddressRange::Parse("0.0.0.0/0")->Contains(Host(200)));
  EXPECT_TRUE(AddressRange::Parse("10.0.0.200")->Contains(Host(200)));
  UdpAddress mapped{.bytes = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 10, 0, 0, 200}, .v6 = true};
  EXPECT_TRUE(AddressRange::Parse("10.0.0.200")->Contains(mapped));
  EXPECT_EQ(mapped.host(), Host(200).host());
  EXPECT_NE(Host(1).host(), Host(2).host());
  UdpAddress local{.bytes = {0xFE, 0x80, 0, 1}, .v6 = true};
  EXPECT_TRUE(AddressRange::Parse("fe80::/10")->Contains(local));
  EXPECT_FALSE(AddressRange::Parse("fec0::/10")->Contains(local));
  for (const char* bad : {"", "10.0.0", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/8x", "fe80::/129", "host"}) {
    EXPECT_FALSE(AddressRange::Parse(bad).ok()) << bad;
  }
}

TEST_F(IntakeTest, EngagementsBecomeEvents) {
  using Kind = SceneEvent::Kind;
  std::vector<uint8_t> bytes(256);
  const auto take = [&](const auto& body) { Take(std::span(bytes).first(EncodePdu({}, body, bytes))); };
  const auto kinds = [&] {
    std::vector<Kind> found;
    for (const SceneEvent& event : Snapshot()->events) found.push_back(event.kind);
    return found;
  };
  Fire fire;
  fire.position_ecef = SomeEntity().position_ecef;
  fire.velocity_mps = {800, 0, 0};
  fire.range_m = 1600;
  take(fire);
  EXPECT_EQ(kinds(), (std::vector<Kind>{Kind::kMuzzleFlash, Kind::kTracer}));
  EXPECT_NEAR(table_.Snapshot()->events[1].end_s, 12.0, 1e-9);
  fire.munition = {1, 1, 7};  // a missile that has its own Entity States
  take(fire);
  EXPECT_EQ(kinds(), (std::vector<Kind>{Kind::kTracer, Kind::kMuzzleFlash}));  // the first flash is over
  Detonation detonation;
  detonation.position_ecef = fire.position_ecef;
  detonation.descriptor.type = {2, 9, 225, 2, 1, 0, 0};
  detonation.descriptor.warhead = 1000;
  detonation.result = 3;
  take(detonation);
  EXPECT_EQ(kinds().back(), Kind::kScorch);
  EXPECT_NEAR(table_.Snapshot()->events.back().end_s, 310.2, 1e-9);
  detonation.descriptor.warhead = 0;  // a bullet
  take(detonation);
  EXPECT_EQ(kinds().back(), Kind::kDust);
  Collision collision;
  collision.issuing = SomeEntity().id;
  take(collision);
  EXPECT_EQ(kinds().back(), Kind::kDust);  // of an entity that nobody knows
  Take(Encoded(SomeEntity()));
  take(collision);
  EXPECT_EQ(kinds().back(), Kind::kCollision);
}

TEST_F(IntakeTest, PartsAreBounded) {
  std::vector<uint8_t> bytes = Encoded(SomeEntity());
  bytes[19] = 20;
  bytes.resize(kEntityStateBytes + 20 * 16);
  bytes[8] = static_cast<uint8_t>(bytes.size() >> 8);
  bytes[9] = static_cast<uint8_t>(bytes.size());
  Take(bytes);
  ASSERT_EQ(Snapshot()->objects.size(), 1u);
  EXPECT_EQ(table_.Snapshot()->objects[0].parts().size(), ObjectRecord::kMaxParts);
}

TEST_F(IntakeTest, WhatIsAttachedIsKeptUntilItIsDetached) {
  const EntityType missile{2, 1, 225, 1, 1, 0, 0};
  const auto attached = [&](uint8_t version, uint8_t change, uint32_t station, const EntityType& type) {
    std::vector<uint8_t> bytes = Encoded(SomeEntity());
    bytes[0] = version;
    bytes[19] = 1;
    const auto part = EncodeParameter(
        {.record_type = VariableParameter::kAttachedPart, .change = change, .part_type = station, .attached = type});
    bytes.insert(bytes.end(), part.begin(), part.end());
    bytes[8] = static_cast<uint8_t>(bytes.size() >> 8);
    bytes[9] = static_cast<uint8_t>(bytes.size());
    Take(bytes);
    const std::shared_ptr<const ObjectSnapshot> snapshot = Snapshot();
    return std::vector<AttachedPart>(snapshot->objects[0].attached().begin(), snapshot->objects[0].attached().end());
  };
  const std::vector<AttachedPart> there = attached(7, 0, 641, missile);
  ASSERT_EQ(there.size(), 1U);
  EXPECT_EQ(there[0].station, 641);
  EXPECT_EQ(there[0].type, missile);
  EXPECT_TRUE(attached(7, 1, 641, missile).empty());       // detached
  EXPECT_EQ(attached(6, 1, 641, missile).size(), 1U);      // the byte counts changes there
  EXPECT_TRUE(attached(7, 0, 641, EntityType{}).empty());  // an empty station
  EXPECT_TRUE(attached(7, 0, 70'000, missile).empty());
}

TEST(Timestamp, UnitsAndWrap) {
  EXPECT_DOUBLE_EQ(SecondsPastHour(0), 0.0);
  EXPECT_NEAR(SecondsPastHour(0xFFFFFFFF), 3600.0, 2e-6);
  EXPECT_TRUE(IsAbsolute(0xFFFFFFFF));
  EXPECT_FALSE(IsAbsolute(0xFFFFFFFE));
  for (const double seconds : {0.0, 0.001, 1234.5, 3599.9, 7200.25, -10.0}) {
    const double expected = std::fmod(seconds + 3600.0, 3600.0);
    EXPECT_NEAR(SecondsPastHour(MakeTimestamp(seconds, true)), expected, 1e-6) << seconds;
  }
  EXPECT_EQ(MakeTimestamp(3600.0 - 1e-9, false), 0u);
}

// ---- single datagrams, each a real one with one edit, and the outcome that is expected of a receiver

struct Outcome {
  IntakeCounters counters;
  std::shared_ptr<const ObjectSnapshot> snapshot;
};

Outcome Receive(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> chars((std::istreambuf_iterator<char>(file)), {});
  const std::vector<uint8_t> bytes(chars.begin(), chars.end());
  ObjectTable table;
  Intake intake(table, {.exercise = uint8_t{1}});
  intake.Take(bytes, {10.0, 1000.0, {}});
  table.Tick(10.0);
  return {intake.counters(), table.Snapshot()};
}

bool ExtrapolatesFinite(const ObjectSnapshot& snapshot) {
  for (const ObjectRecord& record : snapshot.objects) {
    const Pose pose = PoseAt(record.kinematics, 1000.0);
    if (!std::isfinite(glm::dot(pose.position_ecef, pose.position_ecef))) return false;
    if (!std::isfinite(pose.ecef_from_body[0].x + pose.ecef_from_body[2].z)) return false;
  }
  return true;
}

// The manifest's wording, and what it comes to.
void CheckOutcome(const std::string& expected, const Outcome& outcome) {
  const IntakeCounters& c = outcome.counters;
  const auto& objects = outcome.snapshot->objects;
  EXPECT_TRUE(ExtrapolatesFinite(*outcome.snapshot));
  if (expected.starts_with("reject")) {
    EXPECT_EQ(c.rejected_total(), 1u);
    EXPECT_TRUE(objects.empty());
  } else if (expected.starts_with("ignored")) {
    EXPECT_EQ(c.ignored_total(), 1u);
    EXPECT_TRUE(objects.empty());
  } else if (expected.starts_with("filtered")) {
    EXPECT_EQ(c.filtered, 1u);
    EXPECT_TRUE(objects.empty());
  } else if (expected.starts_with("2 PDUs")) {
    EXPECT_EQ(c.received, 2u);
    EXPECT_EQ(c.accepted, 1u);
    EXPECT_EQ(c.ignored_type[72], 1u);
  } else {
    ASSERT_EQ(c.accepted, 1u);
    ASSERT_EQ(c.received, 1u);
    ASSERT_EQ(objects.size(), 1u);
    const bool hidden = expected.starts_with("no visible") || expected.starts_with("flagged");
    EXPECT_EQ(objects[0].visible(), !hidden);
    EXPECT_EQ((objects[0].flags & kObjectMotionClamped) != 0, expected.starts_with("clamped"));
    if (expected.starts_with("treat as")) {
      EXPECT_EQ(objects[0].kinematics.model, DeadReckoning::kStatic);
      EXPECT_NE(objects[0].flags & kObjectUnknownModel, 0);
    }
    for (const char character : objects[0].marking.view()) EXPECT_TRUE(character >= 0x20 && character < 0x7F);
  }
}

TEST(Malformed, EveryDatagramHasItsExpectedOutcome) {
  const std::filesystem::path folder = SharedDis() / "malformed";
  std::ifstream manifest(folder / "MANIFEST.csv");
  if (SharedDis().empty() || !manifest) GTEST_SKIP() << "no ../shared/dis/malformed/MANIFEST.csv";
  std::string line;
  std::getline(manifest, line);
  int files = 0;
  while (std::getline(manifest, line)) {
    const size_t first = line.find(','), second = line.find(',', first + 1);
    std::string expected = line.substr(second + 1);
    const bool quoted = expected.starts_with('"');
    expected = quoted ? expected.substr(1, expected.find('"', 1) - 1) : expected.substr(0, expected.find(','));
    SCOPED_TRACE(line.substr(0, first));
    CheckOutcome(expected, Receive(folder / line.substr(0, first)));
    ++files;
  }
  EXPECT_GE(files, 40);
}

}  // namespace
}  // namespace belvedere::dis

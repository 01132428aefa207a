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
  void Take(std::span<const uint8_t> datagram) { intake_.Take(datagram, 10.0, 1000.0); }
  std::shared_ptr<const ObjectSnapshot> Snapshot() {
    table_.Tick(10.0 + 0.1 * ++ticks_);
    return table_.Snapshot();
  }
  const IntakeCounters& counters() const { return intake_.counters(); }

  ObjectTable table_;
  Intake intake_{table_, uint8_t{1}};
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

TEST(Timestamp, AStateIsAsOfItsTimestampWhereThatCanBe) {
  const double utc_s = 1.7e9 - std::fmod(1.7e9, 3600.0) + 0.1;  // just past an hour
  EXPECT_NEAR(StateTime(MakeTimestamp(utc_s - 0.05, true), 50.0, utc_s), 49.95, 1e-5);
  EXPECT_NEAR(StateTime(MakeTimestamp(utc_s - 0.30, true), 50.0, utc_s), 49.70, 1e-5);  // sent before the hour
  EXPECT_NEAR(StateTime(MakeTimestamp(utc_s + 0.20, true), 50.0, utc_s), 50.20, 1e-5);
  EXPECT_EQ(StateTime(MakeTimestamp(utc_s - 0.05, false), 50.0, utc_s), 50.0);
  EXPECT_EQ(StateTime(MakeTimestamp(utc_s - 60.0, true), 50.0, utc_s), 50.0);
  EXPECT_EQ(StateTime(MakeTimestamp(utc_s + 60.0, true), 50.0, utc_s), 50.0);
  EXPECT_EQ(StateTime(0xFFFFFFFF, 50.0, 1800.0), 50.0);
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
  Intake intake(table, uint8_t{1});
  intake.Take(bytes, 10.0, 1000.0);
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

#include "dis/intake.h"
#include "dis/traffic_stream.h"

#include "dis/traffic_sender.h"
#include "runtime/earth/ellipsoid.h"
#include "tests/dis/fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

namespace belvedere::dis {
namespace {

std::vector<uint8_t> Play(const TrafficOptions& options, double seconds, double call_every_s) {
  auto stream = TrafficStream::Make(options);
  EXPECT_TRUE(stream.ok());
  std::vector<uint8_t> all;
  for (int call = 0; call * call_every_s <= seconds + 1e-9; ++call) {
    const auto due = stream->Advance(call * call_every_s);
    all.insert(all.end(), due.begin(), due.end());
  }
  return all;
}

TEST(Traffic, TheSameSeedSendsTheSameBytesHoweverItIsCalled) {
  const TrafficOptions options{.entities = 60, .seed = 5};
  const std::vector<uint8_t> bytes = Play(options, 10.0, 0.05);
  EXPECT_EQ(bytes, Play(options, 10.0, 1.0));
  TrafficOptions other = options;
  other.seed = 6;
  EXPECT_NE(bytes, Play(other, 10.0, 1.0));
}

TEST(Traffic, SierraFliesOverTheMountainsAndDrivesInTheValley) {
  const auto vehicles = MakeVehicles("sierra", 250, 1);
  ASSERT_TRUE(vehicles.ok());
  ASSERT_EQ(vehicles->size(), 250u);
  const auto ground = std::ranges::count_if(*vehicles, [](const Vehicle& v) { return v.type.is_ground_platform(); });
  EXPECT_EQ(ground, 50);
  EXPECT_EQ(std::ranges::count_if(*vehicles, [](const Vehicle& v) { return v.type.is_air_platform(); }), 200);
  std::set<uint8_t> categories, models;
  for (const Vehicle& vehicle : *vehicles) {
    categories.insert(vehicle.type.category);
    models.insert(static_cast<uint8_t>(vehicle.model));
    EXPECT_FALSE(vehicle.marking.empty());
    for (double t = 0; t < 1000; t += 50) {
      const Geodetic at = ToGeodetic(PositionOn(vehicle.course, t));
      if (vehicle.type.is_ground_platform()) {
        ASSERT_GT(at.latitude_deg, 36.6);
        ASSERT_LT(at.latitude_deg, 37.4);
        ASSERT_GT(at.longitude_deg, -118.42);
        ASSERT_LT(at.longitude_deg, -118.0);
        ASSERT_NEAR(at.height_m, 1200.0, 1.0);
      } else {
        ASSERT_GT(at.latitude_deg, 35.5);
        ASSERT_LT(at.latitude_deg, 39.6);
        ASSERT_GT(at.longitude_deg, -122.0);
        ASSERT_LT(at.longitude_deg, -116.0);
        ASSERT_GT(at.height_m, vehicle.type.category == 57 ? 4500.0 : 1400.0);
        ASSERT_LT(at.height_m, 12001.0);
      }
    }
  }
  EXPECT_GE(categories.size(), 6u);
  EXPECT_GE(models.size(), 3u);
}

TEST(Traffic, UnknownScenariosAndImpossibleNumbersAreRefused) {
  EXPECT_FALSE(MakeVehicles("atlantis", 10, 1).ok());
  EXPECT_FALSE(MakeVehicles("sierra", 0, 1).ok());
  EXPECT_FALSE(MakeVehicles("storm", kMostVehicles + 1, 1).ok());
  EXPECT_FALSE(TrafficStream::Make({.rate_pdus_per_s = -1}).ok());
}

TEST(Traffic, RatesAreTheSlopesOfTheTruth) {
  const auto vehicles = MakeVehicles("sierra", 40, 3);
  for (const Vehicle& vehicle : *vehicles) {
    for (double t = 3.0; t < 600.0; t += 31.7) {
      const TrueState state = TrueStateOf(vehicle.course, t);
      EXPECT_NEAR(glm::length(state.pose.velocity_ecef_mps) / vehicle.course.speed_mps, 1.0, 0.06);
      EXPECT_NEAR(glm::dot(state.pose.ecef_from_body[0], glm::normalize(state.pose.velocity_ecef_mps)), 1.0, 1e-9);
      const Geodetic at = ToGeodetic(state.pose.position_ecef);
      EXPECT_LT(glm::dot(state.pose.ecef_from_body[2], UpAt(at.latitude_deg, at.longitude_deg)), -0.5);  // belly down
      // A second on, the report is still within what roll-in and the straight between turns allow.
      const KinematicState report = Report(vehicle.course, vehicle.model, t);
      const Pose believed = PoseAt(report, t + 0.2), truth = TruePose(vehicle.course, t + 0.2);
      EXPECT_LT(glm::length(believed.position_ecef - truth.position_ecef), 0.3);
      EXPECT_LT(glm::length(believed.velocity_ecef_mps - truth.velocity_ecef_mps), 3.0);
    }
  }
}

TEST(Traffic, ReceiversNeverBelieveAnythingFurtherOffThanTheThresholds) {
  const TrafficOptions options{.entities = 100, .seed = 2};
  auto stream = TrafficStream::Make(options);
  ASSERT_TRUE(stream.ok());
  std::map<uint16_t, KinematicState> believed;
  size_t pdus = 0;
  for (double t = 0; t < 60.0; t += 0.05) {
    const auto bytes = stream->Advance(t + 1e-9);
    for (size_t at = 0; at < bytes.size(); at += kEntityStateBytes) {
      const auto all = ReadAll(bytes.subspan(at, kEntityStateBytes));
      const auto& state = std::get<EntityState>(all.at(0).body);
      KinematicState& motion = believed[state.id.entity];
      motion.position_ecef = state.position_ecef;
      motion.velocity_mps = glm::dvec3(state.velocity_mps);
      motion.acceleration_mps2 = glm::dvec3(state.acceleration_mps2);
      motion.angular_velocity_radps = glm::dvec3(state.angular_velocity_radps);
      motion.orientation = {state.orientation_rad.x, state.orientation_rad.y, state.orientation_rad.z};
      motion.model = DeadReckoningModel(state.model);
      ASSERT_LE(t - motion.time_s, motion.time_s == 0 ? 60.0 : 5.1);
      motion.time_s = t;
      ++pdus;
    }
    for (const auto& [entity, motion] : believed) {
      const Vehicle& vehicle = stream->vehicles()[entity - size_t{1}];
      const glm::dvec3 truth = PositionOn(vehicle.course, t);
      // A threshold, and what can be added to it between two looks.
      ASSERT_LT(glm::length(PoseAt(motion, t).position_ecef - truth), 1.5) << vehicle.marking.view() << " at " << t;
    }
  }
  EXPECT_EQ(believed.size(), 100u);
  EXPECT_GT(pdus, 100u * 11);      // the heartbeat alone
  EXPECT_LT(pdus, 100u * 60 * 2);  // and far less than one a look
}

TEST(Traffic, ARateIsKeptAndEntitiesTakeTurns) {
  const TrafficOptions options{.scenario = "storm", .entities = 50, .rate_pdus_per_s = 1000};
  const std::vector<uint8_t> bytes = Play(options, 2.0, 0.1);
  EXPECT_NEAR(static_cast<double>(bytes.size() / kEntityStateBytes), 2000.0, 2.0);
  std::map<uint16_t, int> times;
  for (size_t at = 0; at < bytes.size(); at += kEntityStateBytes) {
    const auto all = ReadAll(std::span(bytes).subspan(at, kEntityStateBytes));
    ++times[std::get<EntityState>(all.at(0).body).id.entity];
  }
  EXPECT_EQ(times.size(), 50u);
  for (const auto& [entity, count] : times) EXPECT_NEAR(count, 40, 1);
}

TEST(Traffic, ASenderStartsAndStops) {
  auto sender = TrafficSender::Start({.to = {"127.0.0.1", 43999}, .traffic = {.entities = 10}}, Clock::System());
  ASSERT_TRUE(sender.ok()) << sender.message();
  while ((*sender)->sent() == 0) std::this_thread::yield();
  (*sender)->Stop();
  EXPECT_TRUE((*sender)->status().ok());
  EXPECT_FALSE(TrafficSender::Start({.to = {"not numeric", 1}}, Clock::System()).ok());
}

TEST(TrafficStream, AfterAnOutageThePictureIsWholeWithinAHeartbeat) {
  TrafficOptions options;
  options.entities = 200;
  auto stream = TrafficStream::Make(options);
  ASSERT_TRUE(stream.ok());
  ObjectTable table;
  Intake intake(table);
  const auto run = [&](double from_s, double to_s, bool connected) {
    for (double now_s = from_s; now_s < to_s; now_s += 0.05) {
      const std::span<const uint8_t> bytes = stream->Advance(now_s);
      for (size_t at = 0; connected && at < bytes.size(); at += kEntityStateBytes) {
        intake.Take(bytes.subspan(at, kEntityStateBytes), {now_s, 1e9 + now_s, {}});
      }
      table.Tick(now_s);
    }
  };
  run(0, 20, true);
  EXPECT_EQ(table.Ids().size(), 200u);
  run(20, 30, false);
  run(30, 30 + options.heartbeat_s + 0.1, true);
  EXPECT_EQ(table.Ids().size(), 200u);
  run(36, 36 + 150, false);  // for good: nothing stale is left
  EXPECT_TRUE(table.Ids().empty());
}

}  // namespace
}  // namespace belvedere::dis

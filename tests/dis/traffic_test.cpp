#include "dis/adsb.h"
#include "dis/intake.h"
#include "dis/traffic_stream.h"

#include "dis/traffic_sender.h"
#include "runtime/earth/ellipsoid.h"
#include "tests/dis/fixtures.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include <filesystem>

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
      const Geodetic at = ToGeodetic(PositionOf(vehicle, t));
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
      const TrueState state = TrueStateOf(vehicle, t);
      EXPECT_NEAR(glm::length(state.pose.velocity_ecef_mps) / vehicle.course.speed_mps, 1.0, 0.06);
      EXPECT_NEAR(glm::dot(state.pose.ecef_from_body[0], glm::normalize(state.pose.velocity_ecef_mps)), 1.0, 1e-9);
      const Geodetic at = ToGeodetic(state.pose.position_ecef);
      EXPECT_LT(glm::dot(state.pose.ecef_from_body[2], UpAt(at.latitude_deg, at.longitude_deg)), -0.5);  // belly down
      // A second on, the report is still within what roll-in and the straight between turns allow.
      const KinematicState report = Report(vehicle, t);
      const Pose believed = PoseAt(report, t + 0.2), truth = TruePose(vehicle, t + 0.2);
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
      const glm::dvec3 truth = PositionOf(vehicle, t);
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

// Writes rows of one flight a second apart, of which some are no good, as text or gzipped.
std::filesystem::path WriteFlight(const std::string& name, const std::string& rows) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path) << '[' << rows << ']';
  return path;
}

std::string FlightRows(int count) {
  std::string rows;
  for (int i = 0; i < count; ++i) {
    rows += fmt::format(
        "{}{{\"timestamp\": {}, \"icao24\": \"abc\", \"callsign\": \"SWR12\", \"latitude\": {}, \"longitude\": 8.5, "
        "\"altitude\": {}, \"other\": [1, {{\"deep\": null}}]}}",
        i == 0 ? "" : ",", 1'533'099'600'000 + 10'000 * i, 47.0 + 0.02 * i, 30'000 + 25 * (i % 2));
  }
  return rows;
}

TEST(RecordedFlights, AreFlownAsTheyWere) {
  const auto path = WriteFlight("flight.json", FlightRows(60));
  const auto flights = ReadFlights({path.string()}, 10);
  ASSERT_TRUE(flights.ok()) << flights.message();
  ASSERT_EQ(flights->size(), 1u);
  const Vehicle& flight = flights->front();
  EXPECT_EQ(flight.marking.view(), "SWR12");
  EXPECT_EQ(flight.type.category, 57);
  EXPECT_TRUE(IsThere(flight, 0));
  EXPECT_TRUE(IsThere(flight, 59));
  EXPECT_FALSE(IsThere(flight, 60));  // 590 s, ten times as fast
  const Geodetic middle = ToGeodetic(PositionOf(flight, 30.5));
  EXPECT_NEAR(middle.latitude_deg, 47.0 + 0.02 * 30.5, 1e-4);
  EXPECT_NEAR(middle.height_m, 30'012 * 0.3048, 4);
  const double speed_mps = glm::length(TruePose(flight, 30.5).velocity_ecef_mps);
  EXPECT_NEAR(speed_mps, 10 * 0.02 * 111'200 / 10, 30);
  std::filesystem::remove(path);
}

TEST(RecordedFlights, WhatIsNoFlightIsNamed) {
  const auto complaint = [](const std::filesystem::path& path) {
    const auto flights = ReadFlights({path.string()}, 1);
    EXPECT_FALSE(flights.ok());
    EXPECT_NE(flights.message().find(path.string()), std::string::npos);
    return flights.message();
  };
  EXPECT_NE(complaint("/nowhere/flights.json").find("cannot open"), std::string::npos);
  EXPECT_NE(complaint(WriteFlight("text.json", "no json")).find("is not the JSON"), std::string::npos);
  EXPECT_NE(complaint(WriteFlight("empty.json", "")).find("no row has"), std::string::npos);
  EXPECT_NE(complaint(WriteFlight("short.json", FlightRows(2))).find("no flight of"), std::string::npos);
  const auto bad = WriteFlight(
      "places.json", FlightRows(20) +
                         ",{\"timestamp\": 1533099605000, \"icao24\": \"abc\", "
                         "\"callsign\": \"SWR12\", \"latitude\": -47, \"longitude\": 8.5, \"altitude\": 30000}");
  const auto flights = ReadFlights({bad.string()}, 1);
  ASSERT_TRUE(flights.ok());
  for (double t = 0; t < 190; t += 1) EXPECT_GT(ToGeodetic(PositionOf(flights->front(), t)).latitude_deg, 46.9) << t;
}

TEST(RecordedFlights, AnEntityGoesWhenItsFlightIsOver) {
  TrafficOptions options;
  options.flights = {WriteFlight("over.json", FlightRows(30)).string()};
  options.speed = 29;  // 10 s
  auto stream = TrafficStream::Make(options);
  ASSERT_TRUE(stream.ok()) << stream.message();
  ObjectTable table;
  Intake intake(table);
  size_t most = 0;
  for (double now_s = 0; now_s < 11; now_s += 0.05) {
    const std::span<const uint8_t> bytes = stream->Advance(now_s);
    for (size_t at = 0; at < bytes.size(); at += kEntityStateBytes) {
      intake.Take(bytes.subspan(at, kEntityStateBytes), {now_s, 1e9 + now_s, {}});
    }
    most = std::max(most, table.Ids().size());
  }
  EXPECT_EQ(most, 1u);
  EXPECT_TRUE(table.Ids().empty());
  EXPECT_EQ(intake.counters().accepted, intake.counters().received);
}

TEST(TrafficStream, EveryScenarioMovesAsItSays) {
  for (const char* scenario : {"airways", "convoy", "dogfight"}) {
    TrafficOptions options;
    options.scenario = scenario;
    options.entities = 20;
    auto stream = TrafficStream::Make(options), again = TrafficStream::Make(options);
    ASSERT_TRUE(stream.ok()) << stream.message();
    size_t engagements = 0;
    for (double now_s = 0; now_s < 20; now_s += 0.1) {
      const auto bytes = stream->Advance(now_s), same = again->Advance(now_s);
      EXPECT_TRUE(std::ranges::equal(bytes, same));
      for (const std::vector<uint8_t>& datagram : stream->Engagements()) {
        const auto pdus = ReadAll(datagram);
        ASSERT_EQ(pdus.size(), 1u);
        EXPECT_EQ(pdus[0].verdict, Verdict::kDecoded);
        ++engagements;
      }
    }
    EXPECT_EQ(engagements > 0, std::string(scenario) == "dogfight");
    for (const Vehicle& vehicle : stream->vehicles()) {
      const Pose pose = TruePose(vehicle, 100);
      const double speed_mps = glm::length(pose.velocity_ecef_mps), height_m = ToGeodetic(pose.position_ecef).height_m;
      EXPECT_GT(speed_mps, 5) << scenario;
      EXPECT_LT(speed_mps, 400) << scenario;
      EXPECT_GT(height_m, 1000) << scenario;
      EXPECT_LT(height_m, 13'500) << scenario;
      EXPECT_GT(glm::dot(pose.ecef_from_body[0], pose.velocity_ecef_mps), 0.9 * speed_mps) << scenario;
    }
  }
  EXPECT_NE(MakeVehicles("circus", 3, 1).message().find("sierra, storm, airways"), std::string::npos);
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

#include "runtime/app/station_file.h"

#include "runtime/app/settings.h"

#include <gtest/gtest.h>

#include <string>

namespace belvedere {
namespace {

Result<StationSpec> Parse(const std::string& text) {
  return ParseStation(text, "s.toml", "/place");
}
std::string Complaint(const std::string& text) {
  return Parse(text).message();
}

const std::string kWindow = "[[window]]\n[window.view]\nkind = \"free\"\n";

TEST(StationFileTest, ReadsEverything) {
  const auto station = Parse(R"(
dataset = "earth"
models = "/my/models"
cache_MiB = 256
exaggeration = 2
frame_ms = 25
time = "2026-06-21T19:30:00Z"
time_rate = 3600
[feed]
listen = ["127.0.0.1:3000", "239.1.2.3:3001"]
exercise = 7
most_entities = 500
sources = ["10.0.0.0/8"]
managers = ["10.0.0.9"]
refuse_strangers = true
refuse_absurd = true
pdus_per_s = 5000
new_entities_per_s = 100
  [[feed.timeout]]
  entity_type = "1.2"
  version = 6
  stationary = false
  seconds = 30
[render]
max_fps = 30
overlay_slots = 800
[keys]
F2 = "goto 36.5 -118.3 9000 0 -20"
[[window]]
title = "one"
size = [800, 600]
position = [10, -20]
  [window.view]
  kind = "tethered"
  target = "1:2:3"
  distance_m = 50
  azimuth = 90
  elevation = 20
  follow_heading = false
  layers = ["imagery"]
  error_px = 1.5
  hud = false
[[window]]
  [window.view]
  kind = "gods-eye"
  label = "{marking} {speed}"
  effects = false
  groups = false
  on_ground = false
  on_sea = false
  trails = true
  vectors_s = 45
[[watch]]
lat = 37
lon = -118
radius_m = 5000
[[window]]
  [window.view]
  kind = "overview"
  lat = 37
  lon = -119
  span_m = 5e5
)");
  ASSERT_TRUE(station.ok()) << station.message();
  EXPECT_EQ(station->dataset, "/place/earth");
  EXPECT_EQ(station->models, "/my/models");
  EXPECT_EQ(station->cache_MiB, 256);
  EXPECT_EQ(station->exaggeration, 2);
  EXPECT_EQ(station->frame_ms, 25);
  EXPECT_EQ(station->utc_s, 1782070200.0);
  EXPECT_EQ(station->time_rate, 3600.0);
  EXPECT_EQ(station->feed.listen.size(), 2U);
  EXPECT_EQ(station->feed.exercise, 7);
  EXPECT_EQ(station->feed.most_entities, 500U);
  EXPECT_EQ(station->feed.admission.sources.size(), 1U);
  EXPECT_EQ(station->feed.admission.managers.size(), 1U);
  EXPECT_TRUE(station->feed.admission.refuse_strangers && station->feed.admission.refuse_absurd);
  EXPECT_EQ(station->feed.admission.pdus_per_s, 5000);
  EXPECT_EQ(station->feed.admission.new_entities_per_s, 100);
  ASSERT_EQ(station->feed.timeouts.size(), 2U);  // the file's before the standard's
  EXPECT_EQ(station->feed.timeouts[0].version, 6);
  EXPECT_EQ(station->feed.timeouts[0].stationary, false);
  EXPECT_EQ(station->feed.timeouts[0].timeout_s, 30);
  EXPECT_EQ(station->render.max_fps, 30);
  EXPECT_EQ(station->render.overlay_slots, 800);
  ASSERT_EQ(station->keys.size(), 1U);
  ASSERT_EQ(station->windows.size(), 3U);
  const ViewSpec& second = station->windows[1].view;
  EXPECT_NE(second.label_format, nullptr);
  EXPECT_FALSE(second.effects || second.groups || second.on_ground || second.on_sea);
  EXPECT_TRUE(second.trails && second.vectors);  // naming how far turns it on
  EXPECT_EQ(second.vectors_s, 45);
  EXPECT_TRUE(station->windows[2].view.frames);
  ASSERT_EQ(station->watched.size(), 1U);
  EXPECT_EQ(station->watched[0].radius_m, 5000);
  const WindowSpec& one = station->windows[0];
  EXPECT_EQ(one.title, "one");
  EXPECT_EQ(one.width_px, 800);
  EXPECT_EQ(one.position_px->second, -20);
  EXPECT_EQ(one.view.kind, ViewKind::kTethered);
  EXPECT_EQ(one.view.target->kind, TargetRule::Kind::kId);
  EXPECT_EQ(one.view.target->id.entity, 3);
  EXPECT_EQ(one.view.tether.distance_m, 50);
  EXPECT_FALSE(one.view.tether.follows_heading);
  EXPECT_EQ(one.view.error_px, 1.5);
  EXPECT_FALSE(one.view.hud);
  EXPECT_EQ(station->windows[1].view.tether.elevation_deg, 90);
  EXPECT_EQ(station->windows[1].view.target->kind, TargetRule::Kind::kFirst);
  EXPECT_TRUE(station->windows[2].view.symbols);
  EXPECT_EQ(station->windows[2].view.overview.span_m, 5e5);
  EXPECT_EQ(station->windows[2].view.overview.latitude_deg, 37);
}

TEST(StationFileTest, NamesFileLineKeyAndNearestKey) {
  EXPECT_EQ(Complaint("dataset = \"d\"\ncache_MB = 3\n" + kWindow),
            "s.toml:2: cache_MB is not a known key; did you mean cache_MiB?");
  EXPECT_EQ(Complaint("dataset = \"d\"\n" + kWindow + "latt = 3\n"),
            "s.toml:5: window.view.latt is not a known key; did you mean lat?");
  EXPECT_NE(Complaint("dataset = \"d\"\nzzzzzzzz = 1\n" + kWindow).find("known are dataset"), std::string::npos);
}

TEST(StationFileTest, NamesWrongTypesAndRanges) {
  EXPECT_EQ(Complaint("dataset = 3\n" + kWindow), "s.toml:1: dataset must be a string, but is an integer");
  EXPECT_EQ(Complaint("dataset = \"d\"\ncache_MiB = \"much\"\n" + kWindow),
            "s.toml:2: cache_MiB must be an integer, but is a string");
  EXPECT_EQ(Complaint("dataset = \"d\"\n" + kWindow + "lat = 91\n"),
            "s.toml:5: window.view.lat is 91, but must be -90 to 90");
  EXPECT_EQ(Complaint("dataset = \"d\"\n[[window]]\nsize = [1024]\n[window.view]\nkind = \"free\"\n"),
            "s.toml:3: window.size must be an array of 2 integers from 16 to 8192");
  EXPECT_NE(Complaint("dataset = \"d\"\n[[window]]\n[window.view]\nkind = \"map\"\n")
                .find("s.toml:4: window.view.kind is \"map\""),
            std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\ntime = \"noon\"\n" + kWindow).find("s.toml:2: time is \"noon\""),
            std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n" + kWindow + "[feed]\nsources = [\"10.0.0.0/40\"]\n").find("10.0.0.0/40"),
            std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n" + kWindow + "[[feed.timeout]]\nversion = 7\n").find("seconds is missing"),
            std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n" + kWindow + "label = \"{speeed}\"\n").find("\"speeed\" is no field"),
            std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n[[watch]]\nlat = 3\n" + kWindow).find("is missing: a watch area has"),
            std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\nwindow = 3\n").find("must be written as [[window]] tables"), std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n[keys]\nF1 = \"togle hud\"\n" + kWindow).find("did you mean toggle?"),
            std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n[keys]\nHome2 = \"home\"\n" + kWindow).find("did you mean Home?"),
            std::string::npos);
}

TEST(StationFileTest, NamesWhatIsMissing) {
  EXPECT_NE(Complaint(kWindow).find("dataset is missing"), std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n").find("a station needs a [[window]]"), std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n[[window]]\n").find("window.view is missing"), std::string::npos);
  EXPECT_NE(Complaint("dataset = \"d\"\n[[window]]\n[window.view]\n").find("window.view.kind is missing"),
            std::string::npos);
  EXPECT_NE(LoadStation("/nowhere/station.toml").message().find("/nowhere/station.toml: cannot be read"),
            std::string::npos);
}

TEST(StationFileTest, NamesTheLineOfBadToml) {
  EXPECT_EQ(Complaint("dataset = \"d\"\n= 3\n").find("s.toml:2: "), 0U);
}

TEST(StationFileTest, FirstMistakeOfTheFileIsTheOneNamed) {
  EXPECT_EQ(Complaint("dataset = \"d\"\ncache_MB = 3\n[[window]]\nsize = 3\n[window.view]\nkind = \"free\"\n")
                .find("s.toml:2:"),
            0U);
}

TEST(StationFileTest, StationOfTheDemoIsRead) {
  const auto station = LoadStation(std::string(BELVEDERE_SOURCE_DIR) + "/runtime/app/demo/station.toml");
  ASSERT_TRUE(station.ok()) << station.message();
  ASSERT_EQ(station->windows.size(), 4U);
  EXPECT_EQ(station->windows[0].view.kind, ViewKind::kTethered);
  EXPECT_EQ(station->windows[1].view.kind, ViewKind::kGodsEye);
  EXPECT_EQ(station->windows[2].view.kind, ViewKind::kOverview);
  EXPECT_EQ(station->windows[0].view.target_text, station->windows[1].view.target_text);
}

TEST(SettingsTest, NearestWordIsASlipAway) {
  EXPECT_EQ(NearestWord("hieght", {"height", "heading"}), "height");
  EXPECT_EQ(NearestWord("colour", {"lat", "lon"}), "");
}

}  // namespace
}  // namespace belvedere

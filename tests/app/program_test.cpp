// The built program `belvedere`, as a script uses it.

#include "runtime/app/camera_path.h"
#include "tests/app/made_dataset.h"

#include <OpenImageIO/imageio.h>
#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace belvedere {
namespace {

const std::string kProgram = std::string(BELVEDERE_BINARY_DIR) + "/bin/belvedere";

struct Outcome {
  int exit_code = -1;
  std::string output;  // standard output
  std::string errors;
};

std::string TextOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string TempPath(const std::string& name) {
  return testing::TempDir() + "belvedere_program_" + std::to_string(getpid()) + "_" + name;
}

Outcome RunProgram(const std::string& arguments, const std::string& input = "") {
  const std::string in = TempPath("in"), errors = TempPath("err");
  std::ofstream(in) << input;
  Outcome outcome;
  FILE* pipe = popen((kProgram + " " + arguments + " < " + in + " 2> " + errors).c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const size_t read = fread(buffer.data(), 1, buffer.size(), pipe)) outcome.output.append(buffer.data(), read);
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.errors = TextOf(errors);
  std::remove(in.c_str());
  std::remove(errors.c_str());
  return outcome;
}

// Of the picture's texels, all channels.
double MeanOf(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) return -1;
  const OIIO::ImageSpec spec = input->spec();
  std::vector<uint8_t> read(static_cast<size_t>(spec.width * spec.height * spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, read.data()));
  return std::accumulate(read.begin(), read.end(), 0.0) / static_cast<double>(read.size());
}

size_t LinesIn(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(ProgramTest, HelpAndVersionExitZero) {
  EXPECT_EQ(RunProgram("--help").exit_code, 0);
  EXPECT_EQ(RunProgram("tour --help").exit_code, 0);
  const Outcome version = RunProgram("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_NE(version.output.find("belvedere " BELVEDERE_VERSION), std::string::npos);
}

TEST(ProgramTest, WrongCommandLinesExitTwo) {
  for (const char* wrong : {"", "fly", "snapshot /tmp", "snapshot d --lat 91 --lon 0 --height 1 --out x.png",
                            "tour d p", "tour d p --report r --size 10", "run", "height", "height d --unknown"}) {
    const Outcome outcome = RunProgram(wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong;
    EXPECT_FALSE(outcome.errors.empty()) << wrong;
  }
}

TEST(ProgramTest, WhatCannotBeDoneExitsOneWithOneLine) {
  const std::string out = TempPath("none.png");
  for (const std::string& wrong :
       {std::string("height /nowhere/earth"), std::string("run /nowhere/station.toml"),
        "snapshot /nowhere/earth --lat 0 --lon 0 --height 1000 --out " + out,
        std::string("tour /nowhere/earth /nowhere/path.csv --report /nowhere/r.json --headless")}) {
    const Outcome outcome = RunProgram(wrong);
    EXPECT_EQ(outcome.exit_code, 1) << wrong;
    EXPECT_EQ(LinesIn(outcome.errors), 1U) << outcome.errors;
    EXPECT_NE(outcome.errors.find("/nowhere/"), std::string::npos) << outcome.errors;
  }
}

TEST(ProgramTest, HeightAnswersEachLine) {
  const MadeDataset dataset("height");
  const Outcome outcome = RunProgram("height " + dataset.path(), "10 -10\n\n10.5 10.5\n");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  std::istringstream lines(outcome.output);
  double latitude = 0, longitude = 0, ellipsoid_m = 0, slope_deg = 0;
  std::string msl;
  int level = -1;
  ASSERT_TRUE(lines >> latitude >> longitude >> ellipsoid_m >> msl >> level >> slope_deg);
  EXPECT_EQ(latitude, 10);
  EXPECT_EQ(longitude, -10);
  EXPECT_NEAR(ellipsoid_m, kPlainHeight_m, 1e-3);
  EXPECT_EQ(level, 0);
  EXPECT_NEAR(slope_deg, 0, 1e-3);
  ASSERT_TRUE(lines >> latitude >> longitude >> ellipsoid_m >> msl >> level >> slope_deg);
  EXPECT_NEAR(ellipsoid_m, kPlainHeight_m + 100, 1e-3);
  EXPECT_EQ(level, 1);

  const Outcome wrong = RunProgram("height " + dataset.path(), "10 10\nten ten\n95 0\n1 2\n");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(LinesIn(wrong.output), 2U);  // the good lines are answered all the same
  EXPECT_NE(wrong.errors.find("line 2"), std::string::npos);
  EXPECT_NE(wrong.errors.find("line 3"), std::string::npos);
}

TEST(ProgramTest, SnapshotIsTheSameTwiceAndSaysWhatItDrew) {
  const MadeDataset dataset("snapshot");
  const std::string first = TempPath("1.png"), second = TempPath("2.png"), depth = TempPath("1.exr");
  const std::string pose = " --lat 20 --lon 20 --height 3000000 --pitch -70 --size 160x120 --json --out ";
  const Outcome outcome = RunProgram("snapshot " + dataset.path() + pose + first + " --depth " + depth);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  EXPECT_GT(json.at("triangles").get<int>(), 0);
  EXPECT_GT(json.at("nodes").get<int>(), 0);
  EXPECT_GT(json.at("settled_s").get<double>(), 0);
  EXPECT_LE(json.at("achieved_error_px").get<double>(), 2.0);
  ASSERT_EQ(json.at("clip_from_ecef").size(), 16U);
  EXPECT_EQ(TextOf(depth).substr(0, 4), "\x76\x2f\x31\x01");
  ASSERT_EQ(RunProgram("snapshot " + dataset.path() + pose + second).exit_code, 0);
  EXPECT_EQ(TextOf(first), TextOf(second));
  EXPECT_GT(TextOf(first).size(), 100U);
  for (const std::string& file : {first, second, depth}) std::remove(file.c_str());
}

TEST(ProgramTest, SnapshotNamesTheNearestLayer) {
  const MadeDataset dataset("layers");
  const Outcome outcome =
      RunProgram("snapshot " + dataset.path() + " --lat 0 --lon 0 --height 1000 --size 64x64 --layers imagry --out " +
                 TempPath("l.png"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("did you mean imagery?"), std::string::npos) << outcome.errors;
}

TEST(ProgramTest, TourReportsEveryPromisedField) {
  const MadeDataset dataset("tour");
  const std::string path = TempPath("path.csv"), report = TempPath("r.json");
  const std::string csv = TempPath("frames.csv");
  std::ofstream(path) << "t_s,lat_deg,lon_deg,height_m,heading_deg,pitch_deg,roll_deg,vfov_deg\n"
                         "0,10,10,2000000,0,-80,0,60\n1,11,10,1000000,0,-70,0,60\n2,12,10,500000,0,-60,0,60\n";
  const Outcome outcome = RunProgram("tour " + dataset.path() + " " + path +
                                     " --size 160x120 --views 2 --traffic 10 --redraw 1 --headless --report " + report +
                                     " --frame-csv " + csv);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const nlohmann::json json = nlohmann::json::parse(TextOf(report));
  for (const char* field :
       {"renderer",      "build",         "size",    "views",    "error_px",  "seconds",        "frames",
        "fps_mean",      "frame_ms",      "draw_ms", "scene_hz", "triangles", "nodes",          "achieved_error_px",
        "behind_frames", "first_image_s", "cache",   "requests", "uploads",   "peak_rss_bytes", "threads"}) {
    EXPECT_TRUE(json.contains(field)) << field;
  }
  for (const char* field : {"p50", "p95", "p99", "max"}) EXPECT_TRUE(json["frame_ms"].contains(field)) << field;
  for (const char* field : {"budget_bytes", "peak_bytes", "hits", "misses", "evictions", "failed_pages"}) {
    EXPECT_TRUE(json["cache"].contains(field)) << field;
  }
  for (const char* field : {"issued", "served", "cancelled", "p95_wait_ms"}) {
    EXPECT_TRUE(json["requests"].contains(field)) << field;
  }
  EXPECT_EQ(json["size"], "160x120");
  EXPECT_EQ(json["scene_hz"].size(), 2U);
  EXPECT_GT(json["frames"].get<int>(), 1);
  EXPECT_GT(json["traffic"]["received"].get<int>(), 0);
  EXPECT_TRUE(json.contains("paging_ratio"));
  std::istringstream lines(TextOf(csv));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line.find("frame,view,time_s,frame_ms,"), 0U);
  std::map<int, std::set<int>> views_of_frame;  // a view that has not changed is not drawn
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    int frame = 0, view = 0;
    char comma = 0;
    ASSERT_TRUE(words >> frame >> comma >> view) << line;
    EXPECT_TRUE(views_of_frame[frame].insert(view).second) << line;
  }
  EXPECT_EQ(views_of_frame.size(), json["frames"].get<size_t>());
  const auto both = std::count_if(views_of_frame.begin(), views_of_frame.end(), [](const auto& frame) {
    return frame.second == std::set<int>{1, 2};
  });
  EXPECT_GT(2 * static_cast<size_t>(both), views_of_frame.size());
  std::remove(csv.c_str());
  std::remove(path.c_str());
  std::remove(report.c_str());
}

TEST(ProgramTest, StationRunsOffScreenAndLeavesPictures) {
  const MadeDataset dataset("run");
  const std::string station = TempPath("station.toml"), out = TempPath("out");
  std::ofstream(station) << "dataset = \"" << dataset.path() << "\"\n"
                         << "[[window]]\nsize = [160, 120]\n[window.view]\nkind = \"free\"\nlat = 10\n"
                         << "[[window]]\nsize = [120, 80]\n[window.view]\nkind = \"overview\"\n";
  const Outcome outcome = RunProgram("run " + station + " --headless --seconds 1 --out " + out);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  for (const char* picture : {"view-1.png", "view-2.png"}) {
    EXPECT_EQ(TextOf(out + "/" + picture).substr(1, 3), "PNG") << picture;
  }
  std::filesystem::remove_all(out);
  std::remove(station.c_str());
}

TEST(ProgramTest, StationFileMistakesExitOneWithTheLine) {
  const std::string station = TempPath("wrong.toml");
  std::ofstream(station) << "dataset = \"earth\"\ncach_MiB = 3\n";
  const Outcome outcome = RunProgram("run " + station + " --headless --seconds 1 --out " + TempPath("none"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find(station + ":2: cach_MiB is not a known key; did you mean cache_MiB?"),
            std::string::npos)
      << outcome.errors;
  std::remove(station.c_str());
}

TEST(ProgramTest, SnapshotShowsTheStepOfItsTime) {
  const MadeDataset dataset("seasons", true);
  const std::string out = TempPath("season.png");
  const auto snapshot = [&](const std::string& time) {
    const Outcome outcome =
        RunProgram("snapshot " + dataset.path() + " --lat 20 --lon 180 --height 3000000 --size 64x64 --time " + time +
                   " --out " + out);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return std::pair{MeanOf(out), TextOf(out)};
  };
  const auto winter = snapshot("2026-11-01T00:00:00Z");
  // While the view settles the time does not go on.
  const auto summer = snapshot("2026-10-31T23:59:59.9Z");
  EXPECT_GT(winter.first, summer.first + 40) << "white over green";
  EXPECT_EQ(winter.second, snapshot("2026-11-01T00:00:00Z").second);
  EXPECT_EQ(summer.second, snapshot("2026-10-31T23:59:59.9Z").second);
  EXPECT_NEAR(snapshot("1987-01-31T00:00:00Z").first, winter.first, 25) << "until the 1st of March of the next year";
  std::remove(out.c_str());
}

}  // namespace
}  // namespace belvedere

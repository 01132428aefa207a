// The commands of the program `belvedere`, each a function of its options. docs/manual.md describes them.
//
// Threads: the main thread.
#pragma once

#include "runtime/app/program.h"
#include "runtime/earth/units.h"
#include "runtime/scene/view_parameters.h"

#include <optional>
#include <string>
#include <vector>

namespace belvedere {

struct RunOptions {
  std::string station;
  bool headless = false;
  double seconds = 0;  // 0: until closed (with windows) or 20 (headless)
  std::string out = "demo-out";
  std::string trace;
};
int RunStation(const RunOptions& options);

struct TourOptions {
  std::string dataset, path;
  PictureSize size{1024, 768};
  int views = 1;
  double error_px = 2, texel_px = 1.25;
  double frame_ms = 0;
  int traffic = 0;
  bool headless = false;
  std::string frames_folder;
  int every = 30;
  std::vector<std::string> layers;
  int redraw_points = 0;  // where the tour pauses to draw the same lists again
  double seconds = 0;     // 0: the whole path
  int64_t cache_MiB = 512;
  double max_fps = 60;
  double upload_ms = -1;  // what suits the renderer
  bool hud = true;
  std::optional<double> utc_s;
  double time_rate = 1;
  std::string report, frame_csv, trace;
};
int FlyTour(const TourOptions& options);

struct SnapshotOptions {
  std::string dataset;
  Geodetic position;
  double heading_deg = 0, pitch_deg = -90, roll_deg = 0, vfov_deg = 60;
  PictureSize size{1024, 768};
  double error_px = 1, texel_px = 1;  // a still picture can take its time
  std::vector<std::string> layers;
  double exaggeration = 1;
  std::optional<double> utc_s;
  std::string out, depth, trace;
  bool json = false, magenta = false, wireframe = false, volumes = false, unsettled = false;
  GroundTint tint = GroundTint::kNone;
  int64_t cache_MiB = 512;
  double timeout_s = 120;
};
int TakeSnapshot(const SnapshotOptions& options);

struct HeightOptions {
  std::string dataset;
  std::string layer;  // empty: the first elevation layer
};
int AnswerHeights(const HeightOptions& options);

}  // namespace belvedere

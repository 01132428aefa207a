// StationSpec: a station as its TOML file describes it. docs/manual.md lists the keys.
//
// Paths in the file are relative to the file's folder; in the spec they are ready to be opened.
// Threads: values.
#pragma once

#include "dis/admission.h"
#include "render/render_options.h"
#include "runtime/app/overview.h"
#include "runtime/app/target.h"
#include "runtime/app/tether.h"
#include "runtime/base/status.h"
#include "runtime/earth/units.h"
#include "runtime/scene/importance.h"
#include "runtime/scene/label_format.h"
#include "runtime/scene/object_table.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace belvedere {

enum class ViewKind : uint8_t { kFree, kTethered, kGodsEye, kOverview };

struct ViewSpec {
  ViewKind kind = ViewKind::kFree;
  Geodetic position{0, 0, 12'000e3};  // where it starts; where a follower waits for its target
  double heading_deg = 0, pitch_deg = -90;
  double vfov_deg = 60;
  std::optional<TargetRule> target;  // tethered and God's eye: always there
  std::string target_text;
  Tether tether;
  Overview overview;

  std::vector<std::string> layers;  // image layers in their written form (layer_text.h)
  double error_px = 2.0, texel_px = 1.25;
  std::shared_ptr<const LabelFormat> label_format;  // nullptr: the usual one
  double trails_s = 60, vectors_s = 30;             // how far back and ahead, where they are on
  bool effects = true, trails = false, vectors = false, groups = true, frames = false;
  bool on_ground = true, on_sea = true;
  bool hud = true, labels = true, objects = true, symbols = false, sky = true;
};

struct WindowSpec {
  std::string title;
  int width_px = 1024, height_px = 768;
  std::optional<std::pair<int, int>> position_px;
  ViewSpec view;
};

struct FeedSpec {
  std::vector<std::string> listen;  // ADDR:PORT, multicast groups among them
  std::optional<uint8_t> exercise;
  std::string interface_address;  // that joins the groups; empty: the system's choice
  double timeout_s = 12;
  std::vector<TimeoutRule> timeouts = DefaultTimeouts();
  size_t most_entities = 100'000;
  dis::AdmissionOptions admission;
  double scorch_s = 300;  // how long marks of detonations stay
};

struct StationSpec {
  std::string file;     // for messages
  std::string dataset;  // folder
  std::string models;   // folder of models with their catalogue.toml; empty: the project's own
  int64_t cache_MiB = 512;
  double exaggeration = 1;
  double frame_ms = 0;          // the bound on the error is loosened where frames take longer; 0: never
  std::optional<double> utc_s;  // simulated time at the start; nullopt: the real time
  double time_rate = 1;         // seconds of simulated time a second; 0: it stands still
  RenderOptions render;
  FeedSpec feed;
  std::string importance;  // file of the importance table; empty: that of the models
  std::vector<WatchArea> watched;
  std::vector<WindowSpec> windows;
  std::vector<std::pair<std::string, std::string>> keys;  // key -> command in its written form
};

inline constexpr size_t kMostWindows = 16;

Result<StationSpec> LoadStation(const std::string& path);
// name: stands in messages; folder: what relative paths start from.
Result<StationSpec> ParseStation(std::string_view text, const std::string& name, const std::string& folder);

}  // namespace belvedere

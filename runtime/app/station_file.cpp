#include "runtime/app/station_file.h"

#include "runtime/app/key_map.h"
#include "runtime/app/program.h"
#include "runtime/app/settings.h"
#include "runtime/base/iso_time.h"
#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace belvedere {
namespace {

template <typename From, typename To>
void Assign(const std::optional<From>& from, To& to) {
  if (from) to = static_cast<To>(*from);
}

std::string Resolved(const std::string& path, const std::string& folder) {
  return (std::filesystem::path(folder) / path).lexically_normal().string();
}

void ReadKind(SettingsTable& table, ViewSpec& view) {
  static const std::map<std::string, ViewKind> kKinds = {{"free", ViewKind::kFree},
                                                         {"tethered", ViewKind::kTethered},
                                                         {"gods-eye", ViewKind::kGodsEye},
                                                         {"overview", ViewKind::kOverview}};
  const auto text = table.String("kind");
  if (!text) {
    if (!table.Has("kind")) table.Complain("kind", "is missing: free, tethered, gods-eye or overview");
    return;
  }
  const auto found = kKinds.find(*text);
  if (found == kKinds.end()) {
    table.Complain("kind", fmt::format("is \"{}\", but must be free, tethered, gods-eye or overview", *text));
    return;
  }
  view.kind = found->second;
}

void ReadPlace(SettingsTable& table, ViewSpec& view) {
  Assign(table.Number("lat", -90, 90), view.position.latitude_deg);
  Assign(table.Number("lon", -360, 360), view.position.longitude_deg);
  Assign(table.Number("height_m", -12e3, kFarthest_m), view.position.height_m);
  Assign(table.Number("heading", -360, 360), view.heading_deg);
  Assign(table.Number("pitch", -90, 90), view.pitch_deg);
  Assign(table.Number("vfov", 1, 150), view.vfov_deg);
}

void ReadTether(SettingsTable& table, ViewSpec& view) {
  const bool gods_eye = view.kind == ViewKind::kGodsEye;
  view.tether = gods_eye ? Tether{20e3, 0, 90, false} : Tether{};
  view.target_text = table.String("target").value_or("first air");
  view.target = ParseTargetRule(view.target_text);
  if (!view.target) table.Complain("target", "is empty; write \"first air\", an entity as \"1:2:3\" or a marking");
  Assign(table.Number("distance_m", kShortestTether_m, kLongestTether_m), view.tether.distance_m);
  Assign(table.Number("azimuth", -360, 360), view.tether.azimuth_deg);
  Assign(table.Number("elevation", -80, 90), view.tether.elevation_deg);
  Assign(table.Boolean("follow_heading"), view.tether.follows_heading);
}

ViewSpec ReadView(SettingsTable& table) {
  ViewSpec view;
  ReadKind(table, view);
  ReadPlace(table, view);
  if (view.kind == ViewKind::kTethered || view.kind == ViewKind::kGodsEye) ReadTether(table, view);
  if (view.kind == ViewKind::kOverview) {
    Assign(table.Number("span_m", kLeastSpan_m, kWidestSpan_m), view.overview.span_m);
    view.overview.latitude_deg = view.position.latitude_deg;
    view.overview.longitude_deg = view.position.longitude_deg;
    view.symbols = view.frames = true;
  }
  Assign(table.Strings("layers"), view.layers);
  Assign(table.Number("error_px", 0.1, 100), view.error_px);
  Assign(table.Number("texel_px", 0.25, 100), view.texel_px);
  Assign(table.Boolean("hud"), view.hud);
  Assign(table.Boolean("labels"), view.labels);
  if (const auto text = table.String("label")) {
    Result<LabelFormat> format = LabelFormat::Parse(*text);
    if (format.ok()) view.label_format = std::make_shared<const LabelFormat>(std::move(*format));
    if (!format.ok()) table.Complain("label", fmt::format("is wrong: {}", format.message()));
  }
  Assign(table.Boolean("effects"), view.effects);
  Assign(table.Boolean("groups"), view.groups);
  Assign(table.Boolean("frames"), view.frames);
  Assign(table.Boolean("on_ground"), view.on_ground);
  Assign(table.Boolean("on_sea"), view.on_sea);
  Assign(table.Number("trails_s", 1, 3600), view.trails_s);
  view.trails = table.Boolean("trails").value_or(table.Has("trails_s"));
  Assign(table.Number("vectors_s", 1, 3600), view.vectors_s);
  view.vectors = table.Boolean("vectors").value_or(table.Has("vectors_s"));
  Assign(table.Boolean("objects"), view.objects);
  Assign(table.Boolean("symbols"), view.symbols);
  Assign(table.Boolean("sky"), view.sky);
  table.CheckKeys();
  return view;
}

WindowSpec ReadWindow(SettingsTable& table, size_t number) {
  WindowSpec window;
  window.title = table.String("title").value_or(fmt::format("Belvedere {}", number));
  if (const auto size = table.Integers("size", 2, 16, 8192)) {
    window.width_px = static_cast<int>((*size)[0]);
    window.height_px = static_cast<int>((*size)[1]);
  }
  if (const auto position = table.Integers("position", 2, -32'768, 32'767)) {
    window.position_px.emplace(static_cast<int>((*position)[0]), static_cast<int>((*position)[1]));
  }
  if (auto view = table.Table("view")) {
    window.view = ReadView(*view);
  } else if (!table.Has("view")) {
    table.Complain("view", "is missing: a window needs a [window.view] table");
  }
  table.CheckKeys();
  return window;
}

TimeoutRule ReadTimeout(SettingsTable& table) {
  TimeoutRule rule;
  if (const auto types = table.String("entity_type")) {
    const std::optional<EntityPattern> pattern = EntityPattern::Parse(*types);
    if (pattern) rule.types = *pattern;
    if (!pattern) table.Complain("entity_type", fmt::format("is \"{}\", but must be like \"1.2.*.57\"", *types));
  }
  if (const auto version = table.Integer("version", 5, 7)) rule.version = static_cast<uint8_t>(*version);
  rule.stationary = table.Boolean("stationary");
  const auto seconds = table.Number("seconds", 1, 86'400);
  if (!seconds && !table.Has("seconds")) table.Complain("seconds", "is missing: how long such an object may be silent");
  Assign(seconds, rule.timeout_s);
  table.CheckKeys();
  return rule;
}

void ReadAdmission(SettingsTable& table, dis::AdmissionOptions& admission) {
  const auto ranges = [&](std::string_view key, std::vector<dis::AddressRange>& to) {
    const auto texts = table.Strings(key);
    if (!texts) return;
    auto parsed = dis::ParseAddressRanges(*texts);
    if (parsed.ok()) to = std::move(*parsed);
    if (!parsed.ok()) table.Complain(key, parsed.message());
  };
  ranges("sources", admission.sources);
  ranges("managers", admission.managers);
  Assign(table.Boolean("refuse_strangers"), admission.refuse_strangers);
  Assign(table.Boolean("refuse_absurd"), admission.refuse_absurd);
  Assign(table.Number("pdus_per_s", 0, 1e9), admission.pdus_per_s);
  Assign(table.Number("new_entities_per_s", 0, 1e9), admission.new_entities_per_s);
}

FeedSpec ReadFeed(SettingsTable& table) {
  FeedSpec feed;
  Assign(table.Strings("listen"), feed.listen);
  if (const auto exercise = table.Integer("exercise", 0, 255)) feed.exercise = static_cast<uint8_t>(*exercise);
  Assign(table.String("interface"), feed.interface_address);
  Assign(table.Number("timeout_s", 1, 3600), feed.timeout_s);
  std::vector<SettingsTable> timeouts = table.Tables("timeout");
  if (timeouts.size() + feed.timeouts.size() > kMostTimeoutRules) {
    table.Complain("timeout", fmt::format("is given {} times, but there may be {}", timeouts.size(),
                                          kMostTimeoutRules - feed.timeouts.size()));
    timeouts.clear();
  }
  std::vector<TimeoutRule> rules;
  rules.reserve(timeouts.size());
  for (SettingsTable& timeout : timeouts) rules.push_back(ReadTimeout(timeout));
  feed.timeouts.insert(feed.timeouts.begin(), rules.begin(), rules.end());
  Assign(table.Integer("most_entities", 1, 10'000'000), feed.most_entities);
  Assign(table.Number("scorch_s", 0, 86'400), feed.scorch_s);
  ReadAdmission(table, feed.admission);
  table.CheckKeys();
  return feed;
}

void ReadRender(SettingsTable& table, RenderOptions& render) {
  constexpr int64_t kMostSlots = 2048;  // layers of a texture that every OpenGL 4.5 has
  Assign(table.Number("max_fps", 0, 1000), render.max_fps);
  Assign(table.Number("upload_ms", 0.1, 1000), render.upload_budget_ms);
  Assign(table.Integer("colour_slots", 33, kMostSlots), render.colour_slots);
  Assign(table.Integer("overlay_slots", 33, kMostSlots), render.overlay_slots);
  Assign(table.Integer("model_slots", 1, kMostSlots), render.model_slots);
  Assign(table.Integer("samples", -1, 16), render.samples);
  Assign(table.String("font"), render.font_path);
  table.CheckKeys();
}

WatchArea ReadWatch(SettingsTable& table) {
  constexpr double kLargest_m = 5e6;
  const auto latitude = table.Number("lat", -90, 90), longitude = table.Number("lon", -180, 180);
  const auto radius_m = table.Number("radius_m", 0, kLargest_m);
  for (const char* key : {"lat", "lon", "radius_m"}) {
    if (!table.Has(key)) table.Complain(key, "is missing: a watch area has lat, lon and radius_m");
  }
  table.CheckKeys();
  return {ToEcef({latitude.value_or(0), longitude.value_or(0), 0}), radius_m.value_or(0)};
}

void ReadKeys(SettingsTable& table, StationSpec& station) {
  station.keys = table.AllStrings();
  KeyMap keys;
  for (const auto& [key, command] : station.keys) {
    const Status bound = keys.Bind(key, command);
    if (!bound.ok()) table.Complain(key, fmt::format("is wrong: {}", bound.message()));
  }
}

void ReadTime(SettingsTable& root, StationSpec& station) {
  Assign(root.Number("time_rate", -kFastestTime, kFastestTime), station.time_rate);
  const auto text = root.String("time");
  if (!text || *text == "now") return;
  station.utc_s = ParseIsoTime(*text);
  if (!station.utc_s) {
    root.Complain("time", fmt::format("is \"{}\", but must be \"now\" or like \"2026-06-21T19:30:00Z\"", *text));
  }
}

void ReadWindows(SettingsTable& root, StationSpec& station) {
  std::vector<SettingsTable> windows = root.Tables("window");
  if (windows.empty() && !root.Has("window")) root.Complain("window", "is missing: a station needs a [[window]]");
  if (windows.size() > kMostWindows) {
    root.Complain("window",
                  fmt::format("is given {} times, but a station has at most {} windows", windows.size(), kMostWindows));
  }
  for (SettingsTable& window : windows) station.windows.push_back(ReadWindow(window, station.windows.size() + 1));
}

}  // namespace

Result<StationSpec> ParseStation(std::string_view text, const std::string& name, const std::string& folder) {
  const Result<SettingsFile> file = SettingsFile::Parse(text, name);
  if (!file.ok()) return file.status();
  SettingsTable root = file->root();
  StationSpec station;
  station.file = name;
  if (const auto dataset = root.String("dataset")) station.dataset = Resolved(*dataset, folder);
  if (!root.Has("dataset")) root.Complain("dataset", "is missing: the folder that belvedere-build made");
  if (const auto models = root.String("models")) station.models = Resolved(*models, folder);
  Assign(root.Integer("cache_MiB", 16, 1 << 20), station.cache_MiB);
  Assign(root.Number("exaggeration", 0.1, 100), station.exaggeration);
  Assign(root.Number("frame_ms", 0, 1000), station.frame_ms);
  if (const auto file_name = root.String("importance")) station.importance = Resolved(*file_name, folder);
  for (SettingsTable& table : root.Tables("watch")) station.watched.push_back(ReadWatch(table));
  ReadTime(root, station);
  if (auto feed = root.Table("feed")) station.feed = ReadFeed(*feed);
  if (auto render = root.Table("render")) ReadRender(*render, station.render);
  if (auto keys = root.Table("keys")) ReadKeys(*keys, station);
  ReadWindows(root, station);
  root.CheckKeys();
  const Status status = file->status();
  if (!status.ok()) return status;
  return station;
}

Result<StationSpec> LoadStation(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file) return Status::Error("{}: cannot be read; check the name of the station file", path);
  return ParseStation(text.str(), path, std::filesystem::path(path).parent_path().string());
}

}  // namespace belvedere

#include "runtime/app/tour_report.h"

#include "runtime/app/percentiles.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <span>
#include <sstream>

namespace belvedere {
namespace {

using Json = nlohmann::ordered_json;

// One frame of the render thread: all its views together.
struct Frame {
  double time_s = 0, frame_ms = 0, work_ms = 0, upload_ms = 0;
  uint64_t upload_bytes = 0;
  bool behind = false;
};

constexpr double kAround_s = 1;  // frames so near are of like pictures

double Rounded(double value) {
  return std::round(value * 1000) / 1000;
}

Json PercentilesJson(std::span<const double> values, bool with_p99 = true) {
  const Percentiles percentiles = PercentilesOf(values);
  Json json;
  json["p50"] = Rounded(percentiles.p50);
  json["p95"] = Rounded(percentiles.p95);
  if (with_p99) json["p99"] = Rounded(percentiles.p99);
  json["max"] = Rounded(percentiles.max);
  return json;
}

Json MeanAndMax(std::span<const double> values) {
  return {{"mean", Rounded(MeanOf(values))}, {"max", PercentilesOf(values).max}};
}

std::vector<Frame> FramesOf(const std::vector<FrameSample>& samples) {
  std::map<uint64_t, Frame> frames;
  for (const FrameSample& sample : samples) {
    Frame& frame = frames[sample.frame];
    frame.time_s = sample.time_s;
    frame.frame_ms = sample.frame_ms;
    frame.work_ms += sample.draw_ms;
    frame.upload_ms = sample.upload_ms;
    frame.upload_bytes = sample.upload_bytes;
    frame.behind = frame.behind || sample.behind;
  }
  std::vector<Frame> in_order;
  for (auto& [number, frame] : frames) {
    frame.work_ms += frame.upload_ms;
    in_order.push_back(frame);
  }
  return in_order;
}

template <typename Item, typename Function>
std::vector<double> Series(const std::vector<Item>& items, Function value) {
  std::vector<double> series;
  series.reserve(items.size());
  for (const Item& item : items) series.push_back(static_cast<double>(value(item)));
  return series;
}

void AddFrames(const TourReport& report, Json& json) {
  const std::vector<Frame> frames = FramesOf(report.samples);
  const auto frame_ms = Series(frames, [](const Frame& frame) { return frame.frame_ms; });
  const double start_s = frames.empty() ? 0 : frames.front().time_s;
  std::vector<double> later_s, later_ms;
  for (const Frame& frame : frames) {
    if (frame.time_s - start_s <= 1.0) continue;
    later_s.push_back(frame.time_s);
    later_ms.push_back(frame.frame_ms);
  }
  json["frames"] = frames.size();
  json["fps_mean"] = Rounded(report.seconds > 0 ? static_cast<double>(frames.size()) / report.seconds : 0);
  json["frame_ms"] = PercentilesJson(frame_ms);
  json["frame_ms_after_first_second"] = PercentilesJson(later_ms);
  json["frame_over_median_around"] = PercentilesJson(OverMedianAround(later_s, later_ms, kAround_s));
  json["draw_ms"] = PercentilesJson(Series(frames, [](const Frame& frame) { return frame.work_ms; }));
  Json scene_hz = Json::array();
  for (const double hz : report.scene_hz) scene_hz.push_back(Rounded(hz));
  json["scene_hz"] = std::move(scene_hz);
  json["triangles"] = MeanAndMax(Series(report.samples, [](const FrameSample& sample) { return sample.triangles; }));
  json["nodes"] = MeanAndMax(Series(report.samples, [](const FrameSample& sample) { return sample.nodes; }));
  std::vector<double> achieved, held;
  for (const FrameSample& sample : report.samples) {
    if (!sample.has_terrain) continue;
    achieved.push_back(sample.achieved_error_px);
    held.push_back(sample.held_error_px);
  }
  json["achieved_error_px"] = PercentilesJson(achieved, false);
  json["held_error_px"] = PercentilesJson(held, false);
  json["behind_frames"] = std::count_if(frames.begin(), frames.end(), [](const Frame& frame) { return frame.behind; });
  json["first_image_s"] = Rounded(report.first_image_s);
}

Json UploadsJson(const std::vector<FrameSample>& samples) {
  const std::vector<Frame> frames = FramesOf(samples);
  uint64_t bytes = 0;
  std::vector<double> upload_ms;
  for (const Frame& frame : frames) {
    bytes += frame.upload_bytes;
    if (frame.upload_bytes > 0) upload_ms.push_back(frame.upload_ms);
  }
  return {{"bytes", bytes}, {"p99_ms", Rounded(PercentileOf(upload_ms, 0.99))}};
}

// The value of "Name:  123 kB" in /proc/self/status.
int64_t StatusNumber(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(name + ":")) return std::stoll(line.substr(name.size() + 1));
  }
  return 0;
}

}  // namespace

std::string ToJson(const TourReport& report) {
  Json json;
  json["renderer"] = report.renderer;
  json["build"] = "belvedere " BELVEDERE_VERSION " " BELVEDERE_BUILD_TYPE;
  json["size"] = fmt::format("{}x{}", report.width_px, report.height_px);
  json["views"] = report.views;
  json["error_px"] = report.error_px;
  json["seconds"] = Rounded(report.seconds);
  json["complete"] = report.complete;
  AddFrames(report, json);
  json["cache"] = {{"budget_bytes", report.cache.budget_bytes},
                   {"peak_bytes", report.cache.peak_bytes},
                   {"resident_bytes", report.cache.resident_bytes},
                   {"hits", report.cache.hits},
                   {"misses", report.cache.misses},
                   {"evictions", report.cache.evictions},
                   {"failed_pages", report.cache.failed_pages}};
  json["requests"] = {{"issued", report.requests.issued},
                      {"served", report.requests.served},
                      {"cancelled", report.requests.cancelled},
                      {"p95_wait_ms", Rounded(report.requests.p95_wait_ms)}};
  json["uploads"] = UploadsJson(report.samples);
  json["peak_rss_bytes"] = report.peak_rss_bytes;
  json["threads"] = report.threads;
  if (!report.paging_ratios.empty()) {
    json["paging_ratio"] = Rounded(PercentileOf(report.paging_ratios, 0.5));
    Json ratios = Json::array();
    for (const double ratio : report.paging_ratios) ratios.push_back(Rounded(ratio));
    json["paging_ratios"] = std::move(ratios);
  }
  json["traffic"] = {
      {"sent", report.traffic_sent}, {"received", report.traffic_received}, {"lost", report.traffic_lost}};
  return json.dump(2) + "\n";
}

std::string ToCsv(const std::vector<FrameSample>& samples) {
  std::string csv =
      "frame,view,time_s,frame_ms,draw_ms,triangles,nodes,held_error_px,achieved_error_px,behind,upload_ms,upload_"
      "bytes\n";
  for (const FrameSample& s : samples) {
    csv += fmt::format("{},{},{:.4f},{:.3f},{:.3f},{},{},{:.3f},{:.3f},{},{:.3f},{}\n", s.frame, s.view, s.time_s,
                       s.frame_ms, s.draw_ms, s.triangles, s.nodes, s.held_error_px, s.achieved_error_px,
                       s.behind ? 1 : 0, s.upload_ms, s.upload_bytes);
  }
  return csv;
}

RequestQueue::Statistics SumOf(const std::vector<std::unique_ptr<RequestQueue>>& queues) {
  RequestQueue::Statistics sum;
  for (const auto& queue : queues) {
    const RequestQueue::Statistics one = queue->Stats();
    sum.issued += one.issued;
    sum.served += one.served;
    sum.cancelled += one.cancelled;
    sum.waiting += one.waiting;
    sum.peak_waiting = std::max(sum.peak_waiting, one.peak_waiting);
    sum.p95_wait_ms = std::max(sum.p95_wait_ms, one.p95_wait_ms);
  }
  return sum;
}

int64_t PeakResidentBytes() {
  return StatusNumber("VmHWM") * 1024;
}
int ThreadCount() {
  return static_cast<int>(StatusNumber("Threads"));
}

}  // namespace belvedere

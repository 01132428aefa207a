#include "tests/figures/object_figures.h"

#include "dis/traffic_sender.h"
#include "dis/udp_sender.h"
#include "render/image_file.h"
#include "runtime/app/percentiles.h"
#include "runtime/earth/ellipsoid.h"
#include "tests/figures/loaded_station.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

namespace belvedere {
namespace {

void AddThreeViews(Station& station) {
  station.AddView(ViewFrom(station, 1, kOverTheSierra, 330, -12), nullptr);
  station.AddView(ViewFrom(station, 2, {37.2, -118.8, 60'000}, 0, -80), nullptr);
  ViewParameters overview = ViewFrom(station, 3, {37.5, -119.0, 2e6}, 0, -90);
  overview.projection = Projection::kOrthographic;
  overview.ortho_height_m = 400'000;
  overview.symbols = true;
  station.AddView(overview, nullptr);
}

// Aircraft in rows that fill a view from kOverTheSierra straight down, flying north.
std::vector<ObjectRecord> Formation(size_t count) {
  const size_t side = static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<ObjectRecord> records(count);
  for (size_t i = 0; i < count; ++i) {
    const double row = static_cast<double>(i / side),
                 column = static_cast<double>(i % side) - 0.5 * static_cast<double>(side);
    const double span_deg = 0.010 / static_cast<double>(side);
    const Geodetic place{kOverTheSierra.latitude_deg + span_deg * (row - 0.5 * static_cast<double>(side)),
                         kOverTheSierra.longitude_deg + 1.5 * span_deg * column, kOverTheSierra.height_m - 1000};
    ObjectRecord& record = records[i];
    record.id = {1, static_cast<uint16_t>(1 + i / 60'000), static_cast<uint16_t>(1 + i % 60'000)};
    record.type = {EntityType::kPlatform, EntityType::kAir, 225, static_cast<uint8_t>(i % 2 == 0 ? 57 : 1), 1, 0, 0};
    record.force = static_cast<uint8_t>(1 + i % 3);
    record.marking = Marking::Sanitise(fmt::format("E{}", i));
    record.kinematics.model = DeadReckoning::kRvw;
    record.kinematics.position_ecef = ToEcef(place);
    const glm::dmat3 axes = CameraAxes(place.latitude_deg, place.longitude_deg, {}, {}, {});
    record.kinematics.velocity_mps = -1.0 * axes[2];  // the camera looks along its -z
    record.kinematics.orientation = ToEulerAngles(glm::dmat3(-axes[2], axes[0], -axes[1]));
    record.kinematics.angular_velocity_radps = {0, 0, 0.001};
  }
  return records;
}

void SavePicture(Station& station, ViewId id, const std::string& path) {
  const Result<Picture> picture = station.render().Capture(id, Renderer::Moment::kOfLastFrame).get();
  if (!picture.ok()) Give(picture.message());
  const Status written = WritePng(path, picture->width_px, picture->height_px, picture->rgb);
  if (!written.ok()) Give(written.message());
}

struct StormFrames {
  double per_s = 0;
  std::vector<double> frame_ms, objects_ms;
  uint32_t instances = 0;
};

StormFrames MeasureStorm(Station& station, double seconds) {
  StormFrames frames;
  station.render().TakeSamples();
  Sleep(seconds);
  for (const FrameSample& sample : station.render().TakeSamples()) {
    if (sample.view == 1) frames.frame_ms.push_back(sample.frame_ms);
    frames.objects_ms.push_back(sample.objects_ms);
    frames.instances = std::max(frames.instances, sample.instances);
  }
  frames.per_s = static_cast<double>(frames.frame_ms.size()) / seconds;
  return frames;
}

void PrintStorm(const char* what, const StormFrames& frames) {
  fmt::print(
      "three views {}: {:.1f} frames/s, median {:.1f} ms, 99 % {:.1f} ms; {} symbols and models in a list at most, "
      "made in median {:.1f} ms\n",
      what, frames.per_s, PercentileOf(frames.frame_ms, 0.5), PercentileOf(frames.frame_ms, 0.99), frames.instances,
      PercentileOf(frames.objects_ms, 0.5));
}

}  // namespace

int Feed(const std::string& dataset, double seconds) {
  auto station = StartStation(dataset, 512 * kMiB, true);
  AddThreeViews(*station);
  for (const ViewId id : {1U, 2U, 3U}) Settle(*station, id, 60);
  dis::TrafficSenderOptions options;
  options.to = {"127.0.0.1", kPort};
  options.traffic.entities = 5000;
  options.traffic.rate_pdus_per_s = 20'000;
  options.traffic.utc_at_start_s = Clock::System().UtcSeconds();
  auto sender = dis::TrafficSender::Start(options, Clock::System());
  if (!sender.ok()) Give(sender.message());
  station->render().TakeSamples();
  Sleep(seconds);
  (*sender)->Stop();
  std::vector<double> frame_ms;
  for (const FrameSample& sample : station->render().TakeSamples()) {
    if (sample.view == 1) frame_ms.push_back(sample.frame_ms);
  }
  Sleep(0.5);  // for what is still in the socket
  const dis::ReceiverCounters counters = station->receivers().at(0)->Counters();
  const uint64_t sent = (*sender)->sent();
  const double longest_ms = *std::max_element(frame_ms.begin(), frame_ms.end());
  fmt::print(
      "{} PDUs sent in {:.0f} s ({:.0f}/s), {} accepted, {} lost by the kernel, {} entities alive; three views: "
      "{} frames, median {:.1f} ms, 99 % {:.1f} ms, longest {:.1f} ms (limit 150)\n",
      sent, seconds, static_cast<double>(sent) / seconds, counters.intake.accepted, counters.lost_by_kernel,
      counters.objects.alive, frame_ms.size(), PercentileOf(frame_ms, 0.5), PercentileOf(frame_ms, 0.99), longest_ms);
  return counters.intake.accepted + counters.lost_by_kernel == sent && longest_ms < 150 ? 0 : 1;
}

int Entities(const std::string& dataset, size_t count, double seconds, const std::string& picture_path) {
  auto station = StartStation(dataset, 512 * kMiB, false, 0);
  const Clock& clock = Clock::System();
  std::vector<ObjectRecord> records = Formation(count);
  const auto put = [&](ObjectRecord& record) {
    record.kinematics.time_s = record.received_s = clock.NowSeconds();
    station->objects().Put(record);
  };
  for (ObjectRecord& record : records) put(record);
  station->objects().Tick(clock.NowSeconds());
  ViewParameters view = ViewFrom(*station, 1, kOverTheSierra, 0, -90);
  view.eye_velocity_mps = {0.01, 0, 0};  // so that it is drawn again and again
  view.groups = false;
  station->AddView(view, nullptr);
  Settle(*station, 1, 60);
  station->render().TakeSamples();
  size_t next = 0;
  for (const double end_s = clock.NowSeconds() + seconds; clock.NowSeconds() < end_s; Sleep(0.01)) {
    for (size_t i = 0; i < std::min<size_t>(count / 500 + 1, 200); ++i) put(records[next++ % count]);
    station->objects().Tick(clock.NowSeconds());
  }
  // The last frame again and again, in turns: objects moved and placed anew, and all from the same buffers.
  std::vector<double> moved_ms, still_ms;
  for (int turn = 0; turn < 6; ++turn) {
    for (const double ms : station->render().Redraw(1, 20).get()) moved_ms.push_back(ms);
    for (const double ms : station->render().Redraw(1, 20, true).get()) still_ms.push_back(ms);
  }
  std::vector<double> frame_ms, draw_ms, objects_ms;
  uint32_t instances = 0, triangles = 0;
  for (const FrameSample& sample : station->render().TakeSamples()) {
    frame_ms.push_back(sample.frame_ms);
    draw_ms.push_back(sample.draw_ms);
    objects_ms.push_back(sample.objects_ms);
    instances = std::max(instances, sample.instances);
    triangles = std::max(triangles, sample.triangles);
  }
  fmt::print(
      "{} entities, {} in the list: list made in median {:.1f} ms, 95 % {:.1f} ms (limit 8); {} frames, median {:.1f} "
      "ms, "
      "99 % {:.1f} ms, of which drawing {:.1f} ms; {} triangles\n",
      count, instances, PercentileOf(objects_ms, 0.5), PercentileOf(objects_ms, 0.95), frame_ms.size(),
      PercentileOf(frame_ms, 0.5), PercentileOf(frame_ms, 0.99), PercentileOf(draw_ms, 0.5), triangles);
  const double ratio = PercentileOf(moved_ms, 0.5) / PercentileOf(still_ms, 0.5);
  fmt::print("a frame again: {:.1f} ms with objects moved, {:.1f} ms from static buffers, {:.2f} times (limit 1.5)\n",
             PercentileOf(moved_ms, 0.5), PercentileOf(still_ms, 0.5), ratio);
  if (!picture_path.empty()) {
    SavePicture(*station, 1, picture_path);
  }
  return PercentileOf(objects_ms, 0.5) < 8 && ratio <= 1.5 ? 0 : 1;
}

int Storm(const std::string& dataset, size_t count, double seconds, const std::string& picture_path) {
  auto station = StartStation(dataset, 512 * kMiB, true);
  std::vector<ViewParameters> views = {ViewFrom(*station, 1, {37, -118.6, 1.2e7}, 0, -90),
                                       ViewFrom(*station, 2, {37, -118.6, 4e5}, 0, -60),
                                       ViewFrom(*station, 3, {45, 8, 3e6}, 0, -90)};
  std::vector<ViewChannel*> channels;
  for (const ViewParameters& view : views) channels.push_back(&station->AddView(view, nullptr));
  for (const ViewId id : {1U, 2U, 3U}) Settle(*station, id, 60);
  dis::TrafficSenderOptions options;
  options.to = {"127.0.0.1", kPort};
  options.traffic.scenario = "storm";
  options.traffic.entities = count;
  options.traffic.rate_pdus_per_s = 20'000;
  options.traffic.utc_at_start_s = Clock::System().UtcSeconds();
  auto sender = dis::TrafficSender::Start(options, Clock::System());
  if (!sender.ok()) Give(sender.message());
  Sleep(std::max(8.0, 1.5 * static_cast<double>(count) / 20'000));  // until all are there
  const size_t before = ResidentBytesOfProcess();
  const StormFrames grouped = MeasureStorm(*station, seconds);
  const size_t after = ResidentBytesOfProcess();
  if (!picture_path.empty()) SavePicture(*station, 1, picture_path);
  for (size_t i = 0; i < views.size(); ++i) {
    ViewParameters alone = views[i];
    alone.number = 2;
    alone.groups = false;
    alone.symbols = true;  // else they are too small to be shown at all
    channels[i]->parameters.Publish(alone);
  }
  Sleep(2);
  const StormFrames single = MeasureStorm(*station, std::min(seconds, 10.0));
  const dis::ReceiverCounters counters = station->receivers().at(0)->Counters();
  fmt::print("{} entities alive, {} PDUs accepted, {} lost by the kernel; memory {} MiB, {} MiB after {:.0f} s\n",
             counters.objects.alive, counters.intake.accepted, counters.lost_by_kernel, before / kMiB, after / kMiB,
             seconds);
  PrintStorm("with groups (limit 20 frames/s)", grouped);
  PrintStorm("without", single);
  return grouped.per_s >= 20 ? 0 : 1;
}

int Malformed(const std::string& dataset, const std::string& folder) {
  auto station = StartStation(dataset, 512 * kMiB, true);
  ViewParameters flying = ViewFrom(*station, 1, kOverTheSierra, 330, -12);
  flying.eye_velocity_mps = {0.5, 0, 0};  // a view that stands still is drawn once
  ViewChannel& channel = station->AddView(flying, nullptr);
  auto sender = dis::UdpSender::Open({"127.0.0.1", kPort}, "");
  if (!sender.ok()) Give(sender.message());
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Sleep(1.0);
  bool drawing = true;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    const dis::ReceiverCounters before = station->receivers().at(0)->Counters();
    const uint64_t frames_before = channel.frame.Get()->frame;
    const std::span<const uint8_t> datagram(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    if (const Status status = (*sender)->Send(datagram); !status.ok()) Give(status.message());
    Sleep(0.3);
    const dis::ReceiverCounters after = station->receivers().at(0)->Counters();
    const uint64_t frames = channel.frame.Get()->frame - frames_before;
    drawing &= frames > 0;
    fmt::print("{:24} accepted {} rejected {} ignored {} entities {} frames drawn meanwhile {}\n",
               file.filename().string(), after.intake.accepted - before.intake.accepted,
               after.intake.rejected_total() - before.intake.rejected_total(),
               after.intake.ignored_total() - before.intake.ignored_total(), after.objects.alive, frames);
  }
  fmt::print("{} datagrams; the station {} drawing\n", files.size(), drawing ? "went on" : "STOPPED");
  return drawing && !files.empty() ? 0 : 1;
}

}  // namespace belvedere

// Station figures: what a whole station does under load, off-screen, in one process.
//
//   station_figures views DATASET
//       bytes in the cache with three views of one place over those with one
//   station_figures places DATASET [SECONDS]
//       pixels a second with four views of four places over those with one view of one
//   station_figures poles DATASET
//       quadnodes and triangles of views at the poles over those at the equator, from the same heights
//   station_figures feed DATASET [SECONDS]
//       20,000 Entity State PDUs a second from 5,000 entities while three views draw
//   station_figures entities DATASET [COUNT] [SECONDS] [PICTURE.png]
//       COUNT (10,000) aircraft in one view of 1024 x 768: what the object manager and the render thread take
//   station_figures storm DATASET [COUNT] [SECONDS] [PICTURE.png]
//       COUNT (100,000) entities over the Earth and 20,000 PDUs a second, three views
//   station_figures malformed DATASET FOLDER
//       sends every .bin file of the folder to a running station, which goes on drawing
//   station_figures jump DATASET [JUMPS]
//       from a jump to another place of the Earth to the settled view, and to the first frame there
//   station_figures soak DATASET [MINUTES]
//       a random flight in a cache of 256 MiB: bytes and memory of the process by the minute
//
// Prints what was measured; exits 1 when a promise of docs/performance.md is broken.

#include "dis/traffic_sender.h"
#include "dis/udp_sender.h"
#include "render/image_file.h"
#include "runtime/app/percentiles.h"
#include "runtime/app/station.h"
#include "runtime/earth/ellipsoid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

namespace belvedere {
namespace {

constexpr uint16_t kPort = 30'711;
constexpr size_t kMiB = size_t{1} << 20;
constexpr int kOverlaySlots = 960;
const Geodetic kOverTheSierra{37.0, -118.6, 6500};

[[noreturn]] void Give(const std::string& line) {
  fmt::print(stderr, "station_figures: {}\n", line);
  std::fflush(stdout);
  std::_Exit(1);  // a station may be running
}

std::unique_ptr<Station> StartStation(const std::string& dataset, size_t cache_bytes, bool with_feed,
                                      double max_fps = 60, int slots = kOverlaySlots) {
  Result<std::unique_ptr<Context>> context = MakeOffscreenContext();
  if (!context.ok()) Give(context.message());
  StationOptions options;
  options.dataset = dataset;
  options.cache_bytes = cache_bytes;
  options.render.max_fps = max_fps;
  options.render.overlay_slots = slots;
  if (with_feed) {
    options.feed.listen = {fmt::format("127.0.0.1:{}", kPort)};
    options.feed.exercise = 1;
  }
  Result<std::unique_ptr<Station>> station = Station::Start(options, Clock::System(), std::move(*context));
  if (!station.ok()) Give(station.message());
  return std::move(*station);
}

ViewParameters ViewFrom(Station& station, ViewId id, const Geodetic& place, double heading_deg, double pitch_deg) {
  ViewParameters view;
  view.view = id;
  view.number = 1;
  view.time_s = Clock::System().NowSeconds();
  view.utc_s = 72'000;  // midday in California
  view.eye_ecef = ToEcef(place);
  view.ecef_from_camera = CameraAxes(place.latitude_deg, place.longitude_deg, Radians::FromDegrees(heading_deg),
                                     Radians::FromDegrees(pitch_deg), {});
  view.image_layers = UsesOf(*station.ImageLayers({}));
  return view;
}

void Sleep(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Waits until the view draws a settled list; false after that many seconds.
bool Settle(Station& station, ViewId id, double longest_s) {
  for (double waited_s = 0; waited_s < longest_s; waited_s += 0.25) {
    const Result<Picture> picture = station.render().Capture(id, Renderer::Moment::kOfParameters).get();
    if (picture.ok() && picture->settled) return true;
    Sleep(0.25);
  }
  return false;
}

int Views(const std::string& dataset) {
  auto station = StartStation(dataset, 1024 * kMiB, false);
  station->AddView(ViewFrom(*station, 1, kOverTheSierra, 330, -12), nullptr);
  if (!Settle(*station, 1, 120)) Give("one view has not settled in 120 s");
  const size_t one = station->paging().cache.Stats().resident_bytes;
  for (const ViewId id : {2U, 3U}) station->AddView(ViewFrom(*station, id, kOverTheSierra, 330, -12), nullptr);
  for (const ViewId id : {2U, 3U}) {
    if (!Settle(*station, id, 120)) Give("three views have not settled in 120 s");
  }
  const size_t three = station->paging().cache.Stats().resident_bytes;
  const double ratio = static_cast<double>(three) / static_cast<double>(one);
  fmt::print("cache with one view {} MiB, with three of the same place {} MiB: ratio {:.3f} (limit 1.1)\n", one / kMiB,
             three / kMiB, ratio);
  return ratio < 1.1 ? 0 : 1;
}

// Pixels a second that a station draws while its views turn slowly.
double PixelsPerSecond(Station& station, const std::vector<ViewParameters>& views, double seconds) {
  std::vector<ViewChannel*> channels;
  for (const ViewParameters& view : views) channels.push_back(&station.AddView(view, nullptr));
  for (const ViewParameters& view : views) {
    if (!Settle(station, view.view, 120)) Give("a view has not settled in 120 s");
  }
  const double start_s = Clock::System().NowSeconds();
  station.render().TakeSamples();
  double gone_s = 0;
  for (uint64_t number = 2; gone_s < seconds; ++number) {
    for (size_t i = 0; i < views.size(); ++i) {
      ViewParameters turned = views[i];
      turned.number = number;
      turned.time_s = Clock::System().NowSeconds();
      turned.eye_ecef += std::sin(gone_s) * views[i].ecef_from_camera[0];
      channels[i]->parameters.Publish(turned);
    }
    Sleep(0.01);
    gone_s = Clock::System().NowSeconds() - start_s;
  }
  double pixels = 0;
  for (const FrameSample& sample : station.render().TakeSamples()) {
    for (const ViewParameters& view : views)
      pixels += sample.view == view.view ? 1.0 * view.width_px * view.height_px : 0;
  }
  for (const ViewParameters& view : views) station.RemoveView(view.view);
  return pixels / gone_s;
}

int Places(const std::string& dataset, double seconds) {
  auto station = StartStation(dataset, 2048 * kMiB, false, 0, 2048);
  const std::vector<Geodetic> places{kOverTheSierra, {38.0, -119.5, 6500}, {37.6, -118.9, 6000}, {36.9, -118.3, 7000}};
  std::vector<ViewParameters> views;
  double one = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    views.push_back(ViewFrom(*station, static_cast<ViewId>(i + 1), places[i], 330, -12));
    one += PixelsPerSecond(*station, {views.back()}, seconds) / static_cast<double>(places.size());
  }
  const double four = PixelsPerSecond(*station, views, seconds);
  fmt::print("one view {:.1f} megapixels/s (mean of the four places), four views {:.1f}: ratio {:.3f} (limit 0.9)\n",
             one / 1e6, four / 1e6, four / one);
  return four / one >= 0.9 ? 0 : 1;
}

int Poles(const std::string& dataset) {
  auto station = StartStation(dataset, 1024 * kMiB, false);
  ViewParameters view = ViewFrom(*station, 1, {0, 0, 1e7}, 0, -90);
  view.error_px = 1;
  ViewChannel& channel = station->AddView(view, nullptr);
  double worst = 0;
  for (const double height_m : {3e3, 3e4, 3e5, 3e6}) {
    const auto mean_at = [&](const std::vector<double>& latitudes_deg) {
      std::pair<double, double> sum{0, 0};
      int poses = 0;
      for (const double latitude_deg : latitudes_deg) {
        for (const double longitude_deg : {-150.0, -100.0, -25.0, 5.0, 60.0, 85.0, 160.0}) {
          const uint64_t number = view.number;
          view = ViewFrom(*station, 1, {latitude_deg, longitude_deg, height_m}, longitude_deg, -35);
          view.error_px = 1;
          view.number = number + 1;
          channel.parameters.Publish(view);
          if (!Settle(*station, 1, 60)) Give("a view has not settled in 60 s");
          const auto picture = station->render().Capture(1, Renderer::Moment::kOfParameters).get();
          sum.first += picture->nodes;
          sum.second += picture->triangles;
          ++poses;
        }
      }
      return std::pair{sum.first / poses, sum.second / poses};
    };
    const auto [pole_nodes, pole_triangles] = mean_at({-89.99, 89.99});
    const auto [nodes, triangles] = mean_at({-0.3, 0.3});
    fmt::print(
        "{:8.0f} m: at the poles {:.0f} quadnodes, {:.0f} triangles; at the equator {:.0f}, {:.0f}; ratios {:.2f}, "
        "{:.2f}\n",
        height_m, pole_nodes, pole_triangles, nodes, triangles, pole_nodes / nodes, pole_triangles / triangles);
    std::fflush(stdout);
    worst = std::max({worst, pole_nodes / nodes, pole_triangles / triangles});
  }
  fmt::print("largest ratio {:.2f} (limit 1.5)\n", worst);
  return worst < 1.5 ? 0 : 1;
}

void AddThreeViews(Station& station) {
  station.AddView(ViewFrom(station, 1, kOverTheSierra, 330, -12), nullptr);
  station.AddView(ViewFrom(station, 2, {37.2, -118.8, 60'000}, 0, -80), nullptr);
  ViewParameters overview = ViewFrom(station, 3, {37.5, -119.0, 2e6}, 0, -90);
  overview.projection = Projection::kOrthographic;
  overview.ortho_height_m = 400'000;
  overview.symbols = true;
  station.AddView(overview, nullptr);
}

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

size_t ResidentBytesOfProcess() {
  std::ifstream status("/proc/self/statm");
  size_t total_pages = 0, resident_pages = 0;
  status >> total_pages >> resident_pages;
  return resident_pages * 4096;
}

void SavePicture(Station& station, ViewId id, const std::string& path) {
  const Result<Picture> picture = station.render().Capture(id, Renderer::Moment::kOfLastFrame).get();
  if (!picture.ok()) Give(picture.message());
  const Status written = WritePng(path, picture->width_px, picture->height_px, picture->rgb);
  if (!written.ok()) Give(written.message());
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

int Jump(const std::string& dataset, int jumps) {
  constexpr double kLongest_s = 30;
  auto station = StartStation(dataset, 512 * kMiB, false);
  ViewChannel& channel = station->AddView(ViewFrom(*station, 1, {0, 0, 1.2e7}, 0, -90), nullptr);
  if (!Settle(*station, 1, 60)) Give("the first view has not settled in 60 s");
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<double> settled_s, first_s;
  const Clock& clock = Clock::System();
  for (int jump = 0; jump < jumps; ++jump) {
    const bool near = jump % 2 == 0;  // every other one low over the inset, between them somewhere else
    const Geodetic place = near ? Geodetic{uniform(36.8, 38.4), uniform(-120.4, -117.6), uniform(4500, 9000)}
                                : Geodetic{uniform(-80, 80), uniform(-180, 180), std::pow(10.0, uniform(4.0, 6.5))};
    ViewParameters view = ViewFrom(*station, 1, place, uniform(0, 360), uniform(-60, -10));
    view.number = static_cast<uint64_t>(jump) + 2;
    const double start_s = clock.NowSeconds();
    channel.parameters.Publish(view);
    double first = 0;
    for (;; Sleep(0.002)) {
      const auto report = channel.frame.Get();
      const double now_s = clock.NowSeconds() - start_s;
      if (report->view_number < view.number) continue;
      if (first == 0) first = now_s;
      if (report->settled) break;
      if (now_s > kLongest_s) Give(fmt::format("jump {} has not settled in {} s", jump, kLongest_s));
    }
    first_s.push_back(first);
    settled_s.push_back(clock.NowSeconds() - start_s);
    fmt::print("jump {:2} to {:7.3f} {:8.3f}, {:8.0f} m: first frame {:.3f} s, settled {:.3f} s\n", jump,
               place.latitude_deg, place.longitude_deg, place.height_m, first, settled_s.back());
    std::fflush(stdout);
  }
  const double median_s = PercentileOf(settled_s, 0.5);
  fmt::print("{} jumps: first frame median {:.3f} s, settled median {:.3f} s, longest {:.3f} s (limit 1)\n", jumps,
             PercentileOf(first_s, 0.5), median_s, *std::max_element(settled_s.begin(), settled_s.end()));
  return *std::max_element(settled_s.begin(), settled_s.end()) < 1.0 ? 0 : 1;
}

int Soak(const std::string& dataset, double minutes) {
  constexpr size_t kBudget = 256 * kMiB;
  auto station = StartStation(dataset, kBudget, false);
  ViewChannel& channel = station->AddView(ViewFrom(*station, 1, kOverTheSierra, 330, -12), nullptr);
  std::mt19937 random(20);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Geodetic from = kOverTheSierra;
  Geodetic to = from;
  double leg_start_s = 0, leg_s = 0;
  const double start_s = Clock::System().NowSeconds();
  std::vector<size_t> by_minute;
  uint64_t number = 1;
  for (double now_s = 0; static_cast<double>(by_minute.size()) < minutes;
       now_s = Clock::System().NowSeconds() - start_s) {
    if (now_s >= leg_start_s + leg_s) {
      from = to;
      const bool near = uniform(0, 1) < 0.7;  // most legs over the inset, some to the other side of the world
      to = near ? Geodetic{uniform(36.7, 38.5), uniform(-120.6, -117.4), uniform(3500, 15'000)}
                : Geodetic{uniform(-85, 85), uniform(-180, 180), std::pow(10.0, uniform(4.0, 7.0))};
      leg_start_s = now_s;
      leg_s = uniform(5, 20);
    }
    const double share = std::min(1.0, (now_s - leg_start_s) / leg_s);
    const double smooth = share * share * (3 - 2 * share);
    const Geodetic place{std::lerp(from.latitude_deg, to.latitude_deg, smooth),
                         std::lerp(from.longitude_deg, to.longitude_deg, smooth),
                         std::exp(std::lerp(std::log(from.height_m), std::log(to.height_m), smooth))};
    ViewParameters view = ViewFrom(*station, 1, place, now_s * 7, -20);
    view.number = ++number;
    channel.parameters.Publish(view);
    if (now_s >= 60.0 * static_cast<double>(by_minute.size() + 1)) {
      by_minute.push_back(ResidentBytesOfProcess());
      const SharedCache::Statistics cache = station->paging().cache.Stats();
      fmt::print("minute {:2}: process {} MiB, cache {} MiB, peak {} MiB, {} evictions\n", by_minute.size(),
                 by_minute.back() / kMiB, cache.resident_bytes / kMiB, cache.peak_bytes / kMiB, cache.evictions);
      std::fflush(stdout);
    }
    Sleep(0.02);
  }
  const size_t peak = station->paging().cache.Stats().peak_bytes;
  bool steady = true;
  if (by_minute.size() >= 15) {
    const double growth = static_cast<double>(by_minute.back()) / static_cast<double>(by_minute[4]) - 1.0;
    fmt::print("process after {} minutes over after 5: {:+.2f} % (limit 2)\n", by_minute.size(), 100 * growth);
    steady = std::abs(growth) < 0.02;
  }
  const size_t on_gpu = static_cast<size_t>(WithDefaults({}, station->render().facts().software).colour_slots) *
                            ImagePage::MipOffset(kImageMipLevels, ImageFormat::kRGBA8) +
                        static_cast<size_t>(kOverlaySlots) * ImagePage::MipOffset(kImageMipLevels, ImageFormat::kR8);
  const uint64_t failed = station->paging().cache.Stats().failed_pages;
  fmt::print("images on the GPU {} MiB, budget {} MiB; {} failed pages\n", on_gpu / kMiB, kBudget / kMiB, failed);
  fmt::print("cache budget {} MiB, peak {} MiB\n", kBudget / kMiB, peak / kMiB);
  return peak <= kBudget && steady && failed == 0 && on_gpu <= kBudget ? 0 : 1;
}

int Run(const std::vector<std::string>& words) {
  const auto number = [&](size_t index, double otherwise) {
    return words.size() > index ? std::atof(words[index].c_str()) : otherwise;
  };
  if (words.size() >= 2 && words[0] == "views") return Views(words[1]);
  if (words.size() >= 2 && words[0] == "places") return Places(words[1], number(2, 6));
  if (words.size() >= 2 && words[0] == "poles") return Poles(words[1]);
  if (words.size() >= 2 && words[0] == "feed") return Feed(words[1], number(2, 30));
  if (words.size() >= 2 && words[0] == "entities") {
    return Entities(words[1], static_cast<size_t>(number(2, 10'000)), number(3, 10), words.size() > 4 ? words[4] : "");
  }
  if (words.size() >= 2 && words[0] == "storm") {
    return Storm(words[1], static_cast<size_t>(number(2, 100'000)), number(3, 20), words.size() > 4 ? words[4] : "");
  }
  if (words.size() >= 3 && words[0] == "malformed") return Malformed(words[1], words[2]);
  if (words.size() >= 2 && words[0] == "jump") return Jump(words[1], static_cast<int>(number(2, 20)));
  if (words.size() >= 2 && words[0] == "soak") return Soak(words[1], number(2, 20));
  fmt::print(stderr,
             "usage: station_figures views|places|poles|feed|entities|storm|malformed|jump|soak DATASET "
             "[SECONDS|FOLDER|JUMPS|MINUTES]\n");
  return 2;
}

}  // namespace
}  // namespace belvedere

int main(int argc, char** argv) {
  return belvedere::Run(std::vector<std::string>(argv + 1, argv + argc));
}

// Station figures: what a whole station does under load, off-screen, in one process.
//
//   station_figures views DATASET
//       bytes in the cache with three views of one place over those with one
//   station_figures places DATASET [SECONDS]
//       pixels a second with four views of four places over those with one view of one
//   station_figures poles DATASET
//       quadnodes and triangles of views at the poles over those at the equator, from the same heights over ground
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

#include "runtime/app/percentiles.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/dataset.h"
#include "tests/figures/loaded_station.h"
#include "tests/figures/object_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace belvedere {
namespace {

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

// Of the ground over the ellipsoid; exits when it cannot be read.
double GroundAt(const Dataset& dataset, double latitude_deg, double longitude_deg) {
  const std::optional<int> layer = dataset.FindLayer(LayerKind::kElevation);
  if (!layer) return 0;
  const Quadcode node = dataset.FinestContaining(*layer, latitude_deg, longitude_deg);
  const auto page = dataset.ReadElevation(*layer, node);
  if (!page.ok()) Give(page.message());
  return BilinearHeight(**page, node, latitude_deg, longitude_deg);
}

int Poles(const std::string& dataset) {
  const auto pages = Dataset::Open(dataset);
  if (!pages.ok()) Give(pages.message());
  auto station = StartStation(dataset, 1024 * kMiB, false);
  ViewParameters view = ViewFrom(*station, 1, {0, 0, 1e7}, 0, -90);
  view.error_px = 1;
  ViewChannel& channel = station->AddView(view, nullptr);
  double worst_nodes = 0, worst_triangles = 0;
  for (const double height_m : {3e3, 3e4, 3e5, 3e6}) {
    const auto mean_at = [&](const std::vector<double>& latitudes_deg) {
      std::pair<double, double> sum{0, 0};
      int poses = 0;
      for (const double latitude_deg : latitudes_deg) {
        for (const double longitude_deg : {-150.0, -100.0, -25.0, 5.0, 60.0, 85.0, 160.0}) {
          const uint64_t number = view.number;
          const double eye_m = GroundAt(**pages, latitude_deg, longitude_deg) + height_m;
          view = ViewFrom(*station, 1, {latitude_deg, longitude_deg, eye_m}, longitude_deg, -35);
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
    worst_nodes = std::max(worst_nodes, pole_nodes / nodes);
    worst_triangles = std::max(worst_triangles, pole_triangles / triangles);
  }
  fmt::print("largest ratio of quadnodes {:.2f}, of triangles {:.2f} (limit 1.5)\n", worst_nodes, worst_triangles);
  return std::max(worst_nodes, worst_triangles) < 1.5 ? 0 : 1;
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

#include "tests/figures/loaded_station.h"

#include "runtime/earth/ellipsoid.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace belvedere {

[[noreturn]] void Give(const std::string& line) {
  fmt::print(stderr, "station_figures: {}\n", line);
  std::fflush(stdout);
  std::_Exit(1);  // a station may be running
}

std::unique_ptr<Station> StartStation(const std::string& dataset, size_t cache_bytes, bool with_feed, double max_fps,
                                      int slots) {
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

bool Settle(Station& station, ViewId id, double longest_s) {
  for (double waited_s = 0; waited_s < longest_s; waited_s += 0.25) {
    const Result<Picture> picture = station.render().Capture(id, Renderer::Moment::kOfParameters).get();
    if (picture.ok() && picture->settled) return true;
    Sleep(0.25);
  }
  return false;
}

size_t ResidentBytesOfProcess() {
  std::ifstream status("/proc/self/statm");
  size_t total_pages = 0, resident_pages = 0;
  status >> total_pages >> resident_pages;
  return resident_pages * 4096;
}

}  // namespace belvedere

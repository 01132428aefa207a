#include "runtime/app/commands_of_program.h"
#include "runtime/app/ui_thread.h"
#include "runtime/base/log.h"
#include "runtime/base/trace.h"

#include <cstdlib>
#include <filesystem>

namespace belvedere {
namespace {

constexpr size_t kTraceEvents = size_t{1} << 20;
constexpr double kHeadlessSeconds = 20;

StationOptions RoomsOf(const StationSpec& spec) {
  StationOptions rooms;
  rooms.dataset = spec.dataset;
  rooms.models = spec.models;
  rooms.cache_bytes = static_cast<size_t>(spec.cache_MiB) << 20;
  rooms.exaggeration = spec.exaggeration;
  rooms.feed = spec.feed;
  rooms.importance = spec.importance;
  rooms.watched = spec.watched;
  rooms.render = spec.render;
  return rooms;
}

Status MakeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  return error ? Status::Error("{}: cannot make the folder: {}", folder, error.message()) : Status();
}

}  // namespace

int RunStation(const RunOptions& options) {
  if (!options.trace.empty()) Trace::Start(kTraceEvents);
  const Result<StationSpec> spec = LoadStation(options.station);
  if (!spec.ok()) return CouldNot(spec.status());
  const Clock& clock = Clock::System();

  std::unique_ptr<WindowSystem> windows;  // outlives the station, which draws in them
  Result<std::unique_ptr<Context>> context = Status::Error("no context yet");
  if (options.headless) {
    context = MakeOffscreenContext();
    if (Status status = MakeFolder(options.out); !status.ok()) return CouldNot(status);
  } else {
    Result<std::unique_ptr<WindowSystem>> made = WindowSystem::Make(clock);
    if (!made.ok()) return CouldNot(made.status());
    windows = std::move(*made);
    context = windows->SharedContext();
  }
  if (!context.ok()) return CouldNot(context.status());
  Result<std::unique_ptr<Station>> station = Station::Start(RoomsOf(*spec), clock, std::move(*context));
  if (!station.ok()) return CouldNot(station.status());

  UiOptions ui_options;
  ui_options.seconds = options.headless && options.seconds == 0 ? kHeadlessSeconds : options.seconds;
  ui_options.pictures_folder = options.out;
  ui_options.pictures_on_the_way = options.headless;
  UiThread ui(*spec, ui_options, **station, windows.get(), clock);
  Status status = ui.OpenViews();
  if (status.ok()) status = ui.Run();
  ui.CloseViews();
  if (!status.ok()) return CouldNot(status);
  if (!options.trace.empty()) {
    if (Status written = Trace::Write(options.trace); !written.ok()) return CouldNot(written);
  }
  return kExitDone;
}

}  // namespace belvedere

#include "render/image_file.h"
#include "runtime/app/camera_path.h"
#include "runtime/app/commands_of_program.h"
#include "runtime/app/station.h"
#include "runtime/base/log.h"
#include "runtime/base/trace.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <thread>

namespace belvedere {
namespace {

constexpr size_t kTraceEvents = size_t{1} << 18;
constexpr std::chrono::milliseconds kLook{4};  // how often the frame reports are looked at
constexpr ViewId kView = 1;

ViewParameters ParametersOf(const SnapshotOptions& options, std::vector<LayerUse> layers, double now_s) {
  const CameraPose pose{options.position, options.heading_deg, options.pitch_deg, options.roll_deg, options.vfov_deg};
  ViewParameters view;
  view.view = kView;
  view.number = 1;
  view.time_s = now_s;
  view.utc_s = options.utc_s.value_or(EquinoxNoonAt(options.position.longitude_deg));
  view.time_rate = 0;  // however long the view takes to settle
  view.eye_ecef = pose.eye_ecef();
  view.ecef_from_camera = pose.ecef_from_camera();
  view.vertical_fov = Radians::FromDegrees(options.vfov_deg);
  view.width_px = options.size.width_px;
  view.height_px = options.size.height_px;
  view.exaggeration = options.exaggeration;
  view.error_px = options.error_px;
  view.texel_px = options.texel_px;
  view.image_layers = std::move(layers);
  view.draw_objects = view.labels = view.hud = false;
  view.wireframe = options.wireframe;
  view.volumes = options.volumes;
  view.tint = options.tint;
  if (options.magenta) {
    view.sky = false;
    view.background = {1.0F, 0.0F, 1.0F};
  }
  return view;
}

// The picture once the view has settled (or, when asked, as soon as there is any ground in it).
Result<Picture> WaitForPicture(Station& station, const ViewChannel& channel, const SnapshotOptions& options) {
  const double give_up_s = SecondsSinceStart() + options.timeout_s;
  uint64_t looked_at = 0;
  while (!StopAsked()) {
    const std::shared_ptr<const FrameReport> report = channel.frame.Get();
    const bool ready = options.unsettled ? report->nodes > 0 : report->nodes > 0 && report->uploads_pending == 0;
    // A list that has settled may still be on its way to the places of its vertices.
    if (ready && (report->settled || report->terrain_list != looked_at)) {
      looked_at = report->terrain_list;
      Result<Picture> picture = station.render().Capture(kView, Renderer::Moment::kOfParameters).get();
      if (!picture.ok() || picture->settled || options.unsettled) return picture;
    }
    if (SecondsSinceStart() > give_up_s) {
      return Status::Error("{}: the view has not settled in {} s; raise --timeout or --cache-mib", options.out,
                           options.timeout_s);
    }
    std::this_thread::sleep_for(kLook);
  }
  return Status::Error("{}: stopped before the view had settled", options.out);
}

void PrintJson(const Picture& picture, double settled_s, const std::string& renderer) {
  nlohmann::ordered_json json;
  json["settled_s"] = settled_s;
  json["triangles"] = picture.triangles;
  json["nodes"] = picture.nodes;
  json["achieved_error_px"] = picture.achieved_error_px;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) rows.push_back(picture.matrices.clip_from_ecef[column][row]);
  }
  json["clip_from_ecef"] = std::move(rows);
  json["settled"] = picture.settled;
  json["renderer"] = renderer;
  std::printf("%s\n", json.dump().c_str());
}

Status WriteFiles(const Picture& picture, const SnapshotOptions& options) {
  if (Status status = WritePng(options.out, picture.width_px, picture.height_px, picture.rgb); !status.ok()) {
    return status;
  }
  if (options.depth.empty()) return {};
  return WriteDepthExr(options.depth, picture.width_px, picture.height_px, picture.depth_m);
}

}  // namespace

int TakeSnapshot(const SnapshotOptions& options) {
  if (!options.trace.empty()) Trace::Start(kTraceEvents);
  Result<std::unique_ptr<Context>> context = MakeOffscreenContext();
  if (!context.ok()) return CouldNot(context.status());
  StationOptions rooms;
  rooms.dataset = options.dataset;
  rooms.cache_bytes = static_cast<size_t>(options.cache_MiB) << 20;
  rooms.exaggeration = options.exaggeration;
  rooms.render.max_fps = 30;  // leaves the cores to the servers
  rooms.render.upload_budget_ms = 30;
  const Clock& clock = Clock::System();
  Result<std::unique_ptr<Station>> station = Station::Start(rooms, clock, std::move(*context));
  if (!station.ok()) return CouldNot(station.status());
  const Result<std::vector<NamedLayer>> layers = (*station)->ImageLayers(options.layers);
  if (!layers.ok()) return CouldNot(layers.status());

  const double start_s = SecondsSinceStart();
  const ViewChannel& channel = (*station)->AddView(ParametersOf(options, UsesOf(*layers), clock.NowSeconds()), nullptr);
  const Result<Picture> picture = WaitForPicture(**station, channel, options);
  if (!picture.ok()) return CouldNot(picture.status());
  const double settled_s = SecondsSinceStart() - start_s;
  for (const std::string& notice : (*station)->paging().cache.Failures(8)) LogWarning("{}", notice);
  if (Status status = WriteFiles(*picture, options); !status.ok()) return CouldNot(status);
  if (options.json) PrintJson(*picture, settled_s, (*station)->render().facts().renderer);
  if (!options.trace.empty()) {
    if (Status status = Trace::Write(options.trace); !status.ok()) return CouldNot(status);
  }
  return kExitDone;
}

}  // namespace belvedere

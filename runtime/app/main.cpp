// belvedere: the run-time system. Reads the command line and calls the command.

#include "runtime/app/commands_of_program.h"
#include "runtime/base/iso_time.h"
#include "runtime/base/log.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <map>
#include <string>
#include <utility>

namespace belvedere {
namespace {

// Texts that become values after parsing.
struct Texts {
  std::string size = "1024x768", time, layers, background;
};

CLI::Validator SizeText() {
  return CLI::Validator(
      [](std::string& text) {
        return ParseSize(text) ? std::string() : "\"" + text + "\" is not a size like 1024x768, 16 to 8192 pixels";
      },
      "WxH");
}

CLI::Validator TimeText() {
  return CLI::Validator(
      [](std::string& text) {
        return ParseIsoTime(text) ? std::string() : "\"" + text + "\" is not a time like 2026-06-21T19:30:00Z";
      },
      "ISO8601");
}

void AddRun(CLI::App& program, RunOptions& options) {
  CLI::App* command = program.add_subcommand("run", "Opens the windows of a station");
  command->add_option("STATION", options.station, "station file (TOML)")->required();
  command->add_flag("--headless", options.headless, "render the views off-screen");
  command->add_option("--seconds", options.seconds, "how long (default: until closed; headless 20)")
      ->check(CLI::Range(0.0, 1e7));
  command->add_option("--out", options.out, "folder for pictures")->capture_default_str();
  command->add_option("--trace", options.trace, "write a trace of what each thread did");
}

void AddLayers(CLI::App& command, std::vector<std::string>& layers) {
  command
      .add_option("--layers", layers,
                  "image layers, the lowest first: NAME[:opacity=X][:gamma=X][:multiplier=X][:role=R]")
      ->delimiter(',');
}

void AddTour(CLI::App& program, TourOptions& options, Texts& texts) {
  CLI::App* command = program.add_subcommand("tour", "Flies a camera path in real time and reports what it measured");
  command->add_option("DATASET", options.dataset, "dataset folder")->required();
  command->add_option("PATH", options.path, "camera path (CSV)")->required();
  command->add_option("--size", texts.size, "of each view's picture")->check(SizeText())->capture_default_str();
  command->add_option("--views", options.views, "views; view k flies k/N of the path ahead")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command->add_option("--error-px", options.error_px, "bound on the screen-space error")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  command->add_option("--texel-px", options.texel_px, "bound on a texel's size")
      ->check(CLI::Range(0.25, 100.0))
      ->capture_default_str();
  command->add_option("--frame-ms", options.frame_ms, "where frames take longer, the bound is loosened; 0 for never")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->add_option("--traffic", options.traffic, "synthetic moving objects, over a loopback socket")
      ->check(CLI::Range(0, 100'000));
  command->add_flag("--headless", options.headless, "off-screen, also where there is a display");
  AddLayers(*command, options.layers);
  command->add_option("--frames", options.frames_folder, "folder for pictures of the first view");
  command->add_option("--every", options.every, "a picture every so many frames")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--redraw", options.redraw_points,
                   "pause at so many points and draw the same lists again with nothing else running: paging_ratio")
      ->check(CLI::Range(0, 100));
  command->add_option("--seconds", options.seconds, "fly only the first seconds of the path")
      ->check(CLI::Range(0.0, 1e7));
  command->add_option("--cache-mib", options.cache_MiB, "budget of the shared cache")
      ->check(CLI::Range(int64_t{16}, int64_t{1} << 20))
      ->capture_default_str();
  command->add_option("--max-fps", options.max_fps, "frames a second at most, 0 for no limit")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->add_option("--upload-ms", options.upload_ms, "budget of uploads a frame (default: 4, on a GPU 1)")
      ->check(CLI::Range(0.1, 1000.0));
  command->add_flag("!--no-hud", options.hud, "without the heads-up display");
  command
      ->add_option("--time", texts.time,
                   "simulated time at the start: of the sun (default: equinox noon at the path's end), "
                   "and of layers that change with it")
      ->check(TimeText());
  command->add_option("--time-rate", options.time_rate, "seconds of simulated time a second")
      ->check(CLI::Range(-kFastestTime, kFastestTime))
      ->capture_default_str();
  command->add_option("--report", options.report, "report file (JSON)")->required();
  command->add_option("--frame-csv", options.frame_csv, "a line a frame (CSV)");
  command->add_option("--trace", options.trace, "write a trace of what each thread did");
}

void AddSnapshot(CLI::App& program, SnapshotOptions& options, Texts& texts) {
  CLI::App* command = program.add_subcommand("snapshot", "Writes one picture of a settled view");
  command->add_option("DATASET", options.dataset, "dataset folder")->required();
  command->add_option("--lat", options.position.latitude_deg)->required()->check(CLI::Range(-90.0, 90.0));
  command->add_option("--lon", options.position.longitude_deg)->required()->check(CLI::Range(-360.0, 360.0));
  command->add_option("--height", options.position.height_m, "metres above the ellipsoid")
      ->required()
      ->check(CLI::Range(-12e3, 1e9));
  command->add_option("--heading", options.heading_deg, "degrees from north")->capture_default_str();
  command->add_option("--pitch", options.pitch_deg, "0 level, -90 down")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str();
  command->add_option("--roll", options.roll_deg)->capture_default_str();
  command->add_option("--vfov", options.vfov_deg)->check(CLI::Range(0.1, 150.0))->capture_default_str();
  command->add_option("--size", texts.size)->check(SizeText())->capture_default_str();
  command->add_option("--error-px", options.error_px)->check(CLI::Range(0.1, 100.0))->capture_default_str();
  command->add_option("--texel-px", options.texel_px)->check(CLI::Range(0.25, 100.0))->capture_default_str();
  AddLayers(*command, options.layers);
  command->add_option("--exaggeration", options.exaggeration, "of heights")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  command
      ->add_option("--time", texts.time,
                   "simulated time: of the sun (default: equinox noon at the place), and of layers that "
                   "change with it")
      ->check(TimeText());
  command->add_option("--out", options.out, "picture (PNG)")->required();
  command->add_option("--depth", options.depth, "distances along the view axis (EXR)");
  command->add_flag("--json", options.json, "print what was drawn");
  command->add_option("--background", texts.background, "what is seen where no ground is")
      ->check(CLI::IsMember({"sky", "magenta"}));
  command->add_flag("--wireframe", options.wireframe, "edges of triangles alone");
  command->add_flag("--volumes", options.volumes, "bounding volumes over the picture");
  command->add_option("--tint", options.tint, "what the ground is tinted by")
      ->transform(CLI::CheckedTransformer(std::map<std::string, GroundTint>{{"error", GroundTint::kError},
                                                                            {"level", GroundTint::kLevel},
                                                                            {"frame", GroundTint::kFrame},
                                                                            {"image", GroundTint::kImage}}));
  command->add_flag("--unsettled", options.unsettled, "do not wait for the view to settle");
  command->add_option("--cache-mib", options.cache_MiB)
      ->check(CLI::Range(int64_t{16}, int64_t{1} << 20))
      ->capture_default_str();
  command->add_option("--timeout", options.timeout_s, "seconds to settle")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  command->add_option("--trace", options.trace, "write a trace of what each thread did");
}

void AddHeight(CLI::App& program, HeightOptions& options) {
  CLI::App* command = program.add_subcommand(
      "height", "Reads lines \"lat lon\", answers each with \"lat lon ellipsoid_m msl_m level slope_deg\"");
  command->add_option("DATASET", options.dataset, "dataset folder")->required();
  command->add_option("--layer", options.layer, "elevation layer (default: the first)");
}

int Main(int argc, char** argv) {
  CLI::App program("Belvedere: the whole Earth, and what moves on it", "belvedere");
  program.set_version_flag("--version", "belvedere " BELVEDERE_VERSION " (" BELVEDERE_BUILD_TYPE ")");
  program.require_subcommand(1);
  RunOptions run;
  TourOptions tour;
  SnapshotOptions snapshot;
  HeightOptions height;
  Texts tour_texts, snapshot_texts;
  AddRun(program, run);
  AddTour(program, tour, tour_texts);
  AddSnapshot(program, snapshot, snapshot_texts);
  AddHeight(program, height);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kExitDone : kExitWrongUse;
  }
  CatchSignals();
  if (program.got_subcommand("run")) return RunStation(run);
  if (program.got_subcommand("height")) return AnswerHeights(height);
  if (program.got_subcommand("tour")) {
    tour.size = *ParseSize(tour_texts.size);
    if (!tour_texts.time.empty()) tour.utc_s = ParseIsoTime(tour_texts.time);
    return FlyTour(tour);
  }
  snapshot.size = *ParseSize(snapshot_texts.size);
  if (!snapshot_texts.time.empty()) snapshot.utc_s = ParseIsoTime(snapshot_texts.time);
  snapshot.magenta = snapshot_texts.background == "magenta";
  return TakeSnapshot(snapshot);
}

}  // namespace
}  // namespace belvedere

int main(int argc, char** argv) {
  try {
    return belvedere::Main(argc, argv);
  } catch (const std::exception& error) {
    belvedere::LogError("belvedere: {}", error.what());
    return belvedere::kExitCouldNot;
  }
}

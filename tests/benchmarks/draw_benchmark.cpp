// What drawing costs: a full screen of synthetic ground, layer by layer, off-screen.
//
//   draw_benchmark [--size WxH] [--pictures DIR]
// Prints the renderer, the build, and the milliseconds of a frame of each scene: the median, the least, and the
// time of all CPUs together, which other programs on the machine disturb least.

#include "render/image_file.h"
#include "tests/render/synthetic_scene.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

namespace belvedere::testing {
namespace {

constexpr int kFrames = 40;

double Hills(double latitude_deg, double longitude_deg) {
  return 900 + 700 * std::sin(latitude_deg * 190) * std::cos(longitude_deg * 170) +
         90 * std::sin(latitude_deg * 1900) * std::sin(longitude_deg * 2100);
}

Rgba Fields(double u, double v) {
  const bool odd = (static_cast<int>(std::floor(u * 16)) + static_cast<int>(std::floor(v * 16))) % 2 != 0;
  return odd ? Rgba{92, 120, 70, 255} : Rgba{140, 130, 88, 255};
}

struct Options {
  int width = 1024, height = 768;
  std::string pictures;
};

class Bench {
 public:
  Bench(const Options& options, const Clock& clock) : options_(options) {
    auto stage = Stage::Make(scene_, {}, clock);
    if (!stage.ok()) {
      std::fprintf(stderr, "%s\n", stage.message().c_str());
      std::exit(1);
    }
    stage_ = std::move(*stage);
    nodes_ = Block(46.0, 8.0, 9, 8);
  }

  void Run() {
    std::printf("renderer %s, build %s, %d x %d, median of %d frames\n", stage_->renderer->facts().renderer.c_str(),
                BELVEDERE_BUILD_TYPE, options_.width, options_.height, kFrames);
    for (const Quadcode node : nodes_) scene_.AddTerrain(node, Hills);
    Measure("bare ground, steep", Steep(), 8);
    Upload(PageKind::kColour);
    Measure("1 layer, steep", Steep(), 8);
    Upload(PageKind::kOverlay);
    for (const int step : {16, 8, 4, 2}) Measure("2 layers, steep", Steep(), step);
    Measure("2 layers, to the horizon", Level(), 8);
    ViewParameters with_sky = Level();
    with_sky.sky = true;
    Measure("2 layers, to the horizon, sky", with_sky, 8);
    ViewParameters sky_only = LookAt({46.0, 8.0, 8000}, 20, 40, options_.width, options_.height);
    sky_only.sky = true;
    Measure("sky alone", sky_only, 8);
    sky_only.sky = false;
    Measure("nothing", sky_only, 8);
    with_sky.hud = true;
    Measure("2 layers, to the horizon, sky, HUD", with_sky, 8);
  }

 private:
  ViewParameters Steep() const { return LookAt({46.0, 8.0, 30'000}, 0, -80, options_.width, options_.height); }
  ViewParameters Level() const { return LookAt({44.9, 8.0, 6'000}, 0, -14, options_.width, options_.height); }

  void Upload(PageKind kind) {
    for (const Quadcode node : nodes_) {
      std::vector<PagePin> pins;
      if (kind == PageKind::kColour) pins.push_back(scene_.AddColourOf(node, Fields));
      if (kind == PageKind::kOverlay) pins.push_back(scene_.AddOverlay(node, 128));
      stage_->Upload(std::move(pins));
    }
  }

  void Measure(const char* what, const ViewParameters& view, int step) {
    stage_->channel->parameters.Publish(view);
    DisplayList& list = stage_->channel->terrain_lists.back();
    list.Clear();
    AddSurface(list, scene_, nodes_, step);
    list.statistics.height_above_ground_m = 3000;
    stage_->Show(++list_number_);
    const std::clock_t cpu_start = std::clock();
    std::vector<double> draw_ms = stage_->renderer->Redraw(1, kFrames);
    const double cpu_ms = 1000.0 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC / kFrames;
    std::sort(draw_ms.begin(), draw_ms.end());
    const FrameSample sample = stage_->recorder.Take().back();
    std::printf("%-40s step %2d  %6u triangles  %3u quadnodes  %7.2f ms median %7.2f least %7.2f CPU\n", what, step,
                sample.triangles, sample.nodes, draw_ms[kFrames / 2], draw_ms.front(), cpu_ms);
    if (!options_.pictures.empty()) {
      const Picture picture = stage_->Take();
      const std::string path = options_.pictures + "/draw_" + std::to_string(++pictures_) + ".png";
      if (Status status = WritePng(path, picture.width_px, picture.height_px, picture.rgb); !status.ok()) {
        std::fprintf(stderr, "%s\n", status.message().c_str());
      }
    }
  }

  const Options options_;
  Scene scene_;
  std::unique_ptr<Stage> stage_;
  std::vector<Quadcode> nodes_;
  uint64_t list_number_ = 0;
  int pictures_ = 0;
};

}  // namespace
}  // namespace belvedere::testing

int main(int argc, char** argv) {
  belvedere::testing::Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--size") std::sscanf(argv[i + 1], "%dx%d", &options.width, &options.height);
    if (name == "--pictures") options.pictures = argv[i + 1];
  }
  belvedere::testing::Bench(options, belvedere::Clock::System()).Run();
  return 0;
}

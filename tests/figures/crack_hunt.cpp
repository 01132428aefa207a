// Crack hunt: looks for holes in the terrain. From many poses over land, sea, the borders of insets, poles and 180 E,
// the dataset is drawn before a magenta background with no sky, once while its pages are still coming and once settled.
// A magenta pixel whose line of sight meets the ellipsoid under the deepest ground is a hole.
//
// Usage: crack_hunt DATASET [POSES [WIDTHxHEIGHT]]
// Prints the count; exits 1 when there is a hole, with a line for each picture that has one.

#include "runtime/app/ground.h"
#include "runtime/app/station.h"
#include "runtime/earth/ellipsoid.h"
#include "tests/figures/poses.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <cstdlib>
#include <thread>

namespace belvedere {
namespace {

constexpr ViewId kView = 1;
constexpr double kBoundSlack_px = 3.0;  // a bound of 2 px, its quarter more, and rounding
constexpr double kSettle_s = 6.0;       // a pose that takes longer is looked at as it is
constexpr std::chrono::milliseconds kLook{5};

struct Hunt {
  Station& station;
  const Dataset& dataset;
  ViewChannel& channel;
  const Clock& clock;
  ViewParameters view;
  figures::Poses chance;
  int64_t holes = 0;
  int pictures = 0, settled = 0;
};

int64_t CountHoles(const Picture& picture) {
  int64_t holes = 0;
  const double limb_m = HorizonDistance(ToGeodetic(picture.matrices.eye_ecef).height_m);
  const double surely_covered_m = kDeepestGround_m - kBoundSlack_px * limb_m / picture.matrices.pixels_per_radian;
  const glm::dmat4 ecef_from_clip = glm::inverse(picture.matrices.clip_from_ecef);
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const uint8_t* rgb =
          &picture.rgb[3 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width_px) + static_cast<size_t>(x))];
      if (rgb[0] < 250 || rgb[1] > 5 || rgb[2] < 250) continue;
      glm::dvec4 on_sight = ecef_from_clip * glm::dvec4(2.0 * (x + 0.5) / picture.width_px - 1.0,
                                                        1.0 - 2.0 * (y + 0.5) / picture.height_px, 0.5, 1.0);
      on_sight /= on_sight.w;
      const SightLine line{picture.matrices.eye_ecef, glm::normalize(glm::dvec3(on_sight) - picture.matrices.eye_ecef)};
      if (DistanceToEllipsoid(line, surely_covered_m)) ++holes;
    }
  }
  return holes;
}

void Look(Hunt& hunt, int pose, const char* when) {
  const Result<Picture> picture = hunt.station.render().Capture(kView, Renderer::Moment::kOfParameters).get();
  if (!picture.ok()) {
    fmt::print("pose {}: {}\n", pose, picture.message());
    std::exit(1);
  }
  ++hunt.pictures;
  hunt.settled += picture->settled ? 1 : 0;
  const int64_t holes = CountHoles(*picture);
  if (holes == 0) return;
  hunt.holes += holes;
  const Geodetic eye = ToGeodetic(picture->matrices.eye_ecef);
  fmt::print("pose {} {}: {} magenta pixels under the horizon; eye {:.6f} {:.6f} {:.1f} m\n", pose, when, holes,
             eye.latitude_deg, eye.longitude_deg, eye.height_m);
}

// Height of the finest page of the first elevation layer there; 0 where it cannot be read.
double FinestGround(const Dataset& dataset, const Geodetic& place) {
  const std::optional<int> layer = dataset.FindLayer(LayerKind::kElevation);
  if (!layer) return 0;
  const Quadcode node = dataset.FinestContaining(*layer, place.latitude_deg, place.longitude_deg);
  const auto page = dataset.ReadElevation(*layer, node);
  return page.ok() ? BilinearHeight(**page, node, place.latitude_deg, place.longitude_deg) : 0;
}

void Visit(Hunt& hunt, int pose) {
  const Geodetic place = hunt.chance.PlaceOf(pose);
  const double ground_m = std::max(0.0, FinestGround(hunt.dataset, place));
  const double height_m = ground_m + 100.0 + std::pow(10.0, hunt.chance.Uniform(2.0, 6.8));
  hunt.view.eye_ecef = ToEcef({place.latitude_deg, place.longitude_deg, height_m});
  hunt.view.ecef_from_camera = hunt.chance.AxesAt(place, -90, 0);
  hunt.view.time_s = hunt.clock.NowSeconds();
  ++hunt.view.number;
  hunt.channel.parameters.Publish(hunt.view);
  const double start_s = hunt.clock.NowSeconds();
  const uint64_t list_before = hunt.channel.frame.Get()->terrain_list;
  bool seen_coming = false;
  while (hunt.clock.NowSeconds() < start_s + kSettle_s) {
    const std::shared_ptr<const FrameReport> report = hunt.channel.frame.Get();
    if (!seen_coming && report->terrain_list > list_before && report->nodes > 0) {
      seen_coming = true;
      Look(hunt, pose, "while paging");
    }
    if (seen_coming && report->terrain_list > list_before + 1 && report->uploads_pending == 0 && !report->behind) break;
    std::this_thread::sleep_for(kLook);
  }
  Look(hunt, pose, "settled");
}

int Run(const std::string& dataset, int poses, int width_px, int height_px) {
  const auto fail = [](const Status& status) {
    fmt::print(stderr, "crack_hunt: {}\n", status.message());
    return 1;
  };
  const Result<std::unique_ptr<Dataset>> opened = Dataset::Open(dataset);
  if (!opened.ok()) return fail(opened.status());
  Result<std::unique_ptr<Context>> context = MakeOffscreenContext();
  if (!context.ok()) return fail(context.status());
  StationOptions options;
  options.dataset = dataset;
  options.render.max_fps = 30;
  const Clock& clock = Clock::System();
  Result<std::unique_ptr<Station>> station = Station::Start(options, clock, std::move(*context));
  if (!station.ok()) return fail(station.status());

  ViewParameters view;
  view.view = kView;
  view.number = 1;
  view.eye_ecef = ToEcef({0, 0, 2e7});
  view.ecef_from_camera = CameraAxes(0, 0, {}, Radians::FromDegrees(-90), {});
  view.width_px = width_px;
  view.height_px = height_px;
  view.image_layers = UsesOf(*(*station)->ImageLayers({}));
  view.sky = view.hud = view.labels = view.draw_objects = false;
  view.background = {1.0F, 0.0F, 1.0F};
  view.utc_s = 43'200;  // no place is dark enough for its colour to matter
  ViewChannel& channel = (*station)->AddView(view, nullptr);
  Hunt hunt{**station, **opened, channel, clock, view, figures::Poses(**opened, 1998)};
  for (int pose = 0; pose < poses; ++pose) Visit(hunt, pose);
  fmt::print("{} poses, {} pictures of {} x {} ({} settled): {} magenta pixels under the horizon\n", poses,
             hunt.pictures, width_px, height_px, hunt.settled, hunt.holes);
  return hunt.holes == 0 ? 0 : 1;
}

}  // namespace
}  // namespace belvedere

int main(int argc, char** argv) {
  int poses = 500, width = 640, height = 480;
  if (argc > 2) poses = std::atoi(argv[2]);
  if (argc < 2 || argc > 4 || poses < 1 || (argc == 4 && std::sscanf(argv[3], "%dx%d", &width, &height) != 2)) {
    fmt::print(stderr, "usage: {} DATASET [POSES [WIDTHxHEIGHT]]\n", argv[0]);
    return 2;
  }
  return belvedere::Run(argv[1], poses, width, height);
}

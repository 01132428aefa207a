// Screen-space error: every seen point of the drawn surface against the full-resolution one, from many poses.
//
// Each pixel of a settled picture is taken back to where it lies on the drawn surface; the full-resolution surface at
// that latitude and longitude is that of the finest page's triangles; both points are projected by clip_from_ecef, and
// their distance on the picture is the error. Where that is over the bound, the full-resolution surface a little before
// and behind along the line of sight is tried too: on a wall seen edge-on, its nearest point is not the one above or
// below. Poses lie anywhere on the Earth, over the inset and its border, at the poles and at 180 E; half of them with
// heights exaggerated ten times.
//
// Usage: screen_error DATASET [POSES [BOUND_PX]]
// Prints a line a pose and the worst; exits 1 when a point is over the bound by more than 0.1 px, or a view does not
// settle.

#include "runtime/app/station.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/frame.h"
#include "tests/figures/poses.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <thread>

namespace belvedere {
namespace {

constexpr ViewId kView = 1;
constexpr int kWidth_px = 640, kHeight_px = 480;
constexpr int kStride_px = 3;  // every third pixel of every third row
constexpr double kOverBound_px = 0.1;
constexpr int kTriesAlongSight = 400;
constexpr double kLongestSettling_s = 60;
constexpr std::chrono::milliseconds kLook{10};

// The finest pages' triangles.
class FullSurface {
 public:
  FullSurface(const Dataset& dataset, double exaggeration)
      : dataset_(dataset), layer_(dataset.FindLayer(LayerKind::kElevation).value_or(-1)), exaggeration_(exaggeration) {}

  // The point of the triangles over or under the place. Within a triangle columns and rows are not quite longitudes and
  // latitudes, least of all by a pole.
  glm::dvec3 At(double latitude_deg, double longitude_deg) {
    constexpr int kTries = 4;
    double latitude = latitude_deg, longitude = longitude_deg;
    glm::dvec3 point = AtShares(latitude, longitude);
    for (int i = 0; i < kTries && std::abs(latitude_deg) < kNearPole_deg; ++i) {
      const Geodetic there = ToGeodetic(point);
      latitude = std::clamp(latitude + latitude_deg - there.latitude_deg, -90.0, 90.0);
      longitude += std::remainder(longitude_deg - there.longitude_deg, 360.0);
      point = AtShares(latitude, longitude);
    }
    return point;
  }
  double HeightAt(const Geodetic& place) { return ToGeodetic(At(place.latitude_deg, place.longitude_deg)).height_m; }

 private:
  static constexpr double kNearPole_deg = 89.999;

  // The point of the triangles with the shares that the latitude and longitude have of a cell.
  glm::dvec3 AtShares(double latitude_deg, double longitude_deg) {
    const Quadcode node = dataset_.FinestContaining(layer_, latitude_deg, longitude_deg);
    const ElevationPage& page = PageOf(node);
    const GeoBox box = node.Box();
    const Steps step = StepsOf(node);
    const double east_deg =
        std::remainder(longitude_deg - box.west_deg - 0.5 * node.WidthDegrees(), 360.0) + 0.5 * node.WidthDegrees();
    const double x = std::clamp(east_deg / step.east_deg, 0.0, double{kCells});
    const double y = std::clamp((latitude_deg - box.south_deg) / step.north_deg, 0.0, double{kCells});
    const int i = std::min(static_cast<int>(x), kCells - 1);
    const int j = std::min(static_cast<int>(y), kCells - 1);
    const double u = x - i, v = y - j;
    const auto post = [&](int east, int north) {
      if (const auto laid = LaidAt(node, i + east, j + north)) return *laid;
      return ToEcef({box.south_deg + (j + north) * step.north_deg, box.west_deg + (i + east) * step.east_deg,
                     page.at(i + east, j + north) * 1e-3 * exaggeration_});
    };
    // The diagonal of a cell: see preproc/surface_error.h.
    if ((i + j) % 2 == 0) {
      return u >= v ? (1 - u) * post(0, 0) + (u - v) * post(1, 0) + v * post(1, 1)
                    : (1 - v) * post(0, 0) + (v - u) * post(0, 1) + u * post(1, 1);
    }
    return u + v <= 1 ? (1 - u - v) * post(0, 0) + u * post(1, 0) + v * post(0, 1)
                      : (u + v - 1) * post(1, 1) + (1 - v) * post(1, 0) + (1 - u) * post(0, 1);
  }

  struct Steps {
    double east_deg = 0, north_deg = 0;
  };
  static Steps StepsOf(Quadcode node) { return {node.WidthDegrees() / kCells, node.HeightDegrees() / kCells}; }

  // Posts on a border beyond which pages are coarser lie on the straight edge of the coarser page's cells.
  std::optional<glm::dvec3> LaidAt(Quadcode node, int column, int row) {
    struct Way {
      int east, north;
      bool here;
    };
    for (const Way way :
         {Way{-1, 0, column == 0}, {1, 0, column == kCells}, {0, -1, row == 0}, {0, 1, row == kCells}}) {
      if (!way.here) continue;
      const std::optional<Quadcode> beside =
          way.north != 0 ? node.BesideParallel(way.north > 0)
                         : Quadcode::FromColumnRow(node.level(), node.column() + way.east, node.row());
      if (!beside || dataset_.Exists(layer_, *beside)) continue;
      Quadcode coarser = *beside;
      while (!dataset_.Exists(layer_, coarser)) coarser = coarser.Parent();
      const ElevationPage& page = PageOf(coarser);
      const GeoBox box = coarser.Box();
      const Steps step = StepsOf(coarser);
      const auto edge = [&](int along) {
        const int at_column = way.east == 0 ? along : way.east < 0 ? kCells : 0;
        const int at_row = way.north == 0 ? along : way.north < 0 ? kCells : 0;
        return ToEcef({box.south_deg + at_row * step.north_deg, box.west_deg + at_column * step.east_deg,
                       page.at(at_column, at_row) * 1e-3 * exaggeration_});
      };
      const GridPoint from = node.SouthWest(), to = coarser.SouthWest();
      const uint32_t position = way.east != 0 ? from.y + static_cast<uint32_t>(row) * node.PostSpacingNorth() - to.y
                                              : from.x + static_cast<uint32_t>(column) * node.PostSpacingEast() - to.x;
      const double along =
          static_cast<double>(position) / (way.east != 0 ? coarser.PostSpacingNorth() : coarser.PostSpacingEast());
      const int first = std::min(static_cast<int>(along), kCells - 1);
      return glm::mix(edge(first), edge(first + 1), along - first);
    }
    return std::nullopt;
  }

  const ElevationPage& PageOf(Quadcode node) {
    std::shared_ptr<const ElevationPage>& page = pages_[node];
    if (page) return *page;
    const auto read = dataset_.ReadElevation(layer_, node);
    if (!read.ok()) {
      fmt::print(stderr, "screen_error: {}\n", read.message());
      std::exit(1);
    }
    return *(page = *read);
  }

  const Dataset& dataset_;
  const int layer_;
  const double exaggeration_;
  std::map<Quadcode, std::shared_ptr<const ElevationPage>> pages_;
};

struct Errors {
  std::vector<double> px;
  Geodetic worst_place;
};

Errors Measure(const Picture& picture, FullSurface& surface, double bound_px) {
  Errors errors;
  double worst = 0;
  const ViewMatrices& matrices = picture.matrices;
  const glm::dmat4 camera_from_clip = glm::inverse(matrices.clip_from_camera);
  const auto on_picture = [&](const glm::dvec3& ecef) {
    const glm::dvec4 clip = matrices.clip_from_ecef * glm::dvec4(ecef, 1.0);
    return glm::dvec2(clip.x / clip.w * 0.5 * picture.width_px, clip.y / clip.w * 0.5 * picture.height_px);
  };
  for (int row = 0; row < picture.height_px; row += kStride_px) {
    for (int column = 0; column < picture.width_px; column += kStride_px) {
      const auto depth_m = static_cast<double>(
          picture
              .depth_m[static_cast<size_t>(row) * static_cast<size_t>(picture.width_px) + static_cast<size_t>(column)]);
      if (!std::isfinite(depth_m)) continue;
      const glm::dvec2 clip(2.0 * (column + 0.5) / picture.width_px - 1.0, 1.0 - 2.0 * (row + 0.5) / picture.height_px);
      const glm::dvec3 in_camera(clip.x * depth_m * camera_from_clip[0][0], clip.y * depth_m * camera_from_clip[1][1],
                                 -depth_m);
      const glm::dvec3 drawn = glm::transpose(glm::dmat3(matrices.camera_from_ecef)) * in_camera + matrices.eye_ecef;
      const Geodetic place = ToGeodetic(drawn);
      const auto error_at = [&](const glm::dvec3& point) {
        const Geodetic below = ToGeodetic(point);
        return glm::distance(on_picture(drawn), on_picture(surface.At(below.latitude_deg, below.longitude_deg)));
      };
      double error_px = error_at(drawn);
      if (error_px > bound_px) {
        const double size_m = error_px * depth_m / matrices.pixels_per_radian;
        const glm::dvec3 along = glm::normalize(drawn - matrices.eye_ecef);
        for (int step = -kTriesAlongSight; step <= kTriesAlongSight; ++step) {
          error_px = std::min(error_px, error_at(drawn + (2.0 * size_m * step / kTriesAlongSight) * along));
        }
      }
      errors.px.push_back(error_px);
      if (errors.px.back() <= worst) continue;
      worst = errors.px.back();
      errors.worst_place = place;
    }
  }
  return errors;
}

// The settled picture of the pose; exits when it does not settle.
Picture Settled(Station& station, ViewChannel& channel, const ViewParameters& view) {
  channel.parameters.Publish(view);
  const Clock& clock = Clock::System();
  for (const double start_s = clock.NowSeconds(); clock.NowSeconds() < start_s + kLongestSettling_s;) {
    Result<Picture> picture = station.render().Capture(kView, Renderer::Moment::kOfParameters).get();
    if (picture.ok() && picture->settled) return std::move(*picture);
    std::this_thread::sleep_for(kLook);
  }
  fmt::print("the view has not settled in {:.0f} s\n", kLongestSettling_s);
  std::exit(1);
}

double Run(const Dataset& dataset, const std::string& path, int poses, double bound_px, double exaggeration) {
  Result<std::unique_ptr<Context>> context = MakeOffscreenContext();
  StationOptions options;
  options.dataset = path;
  options.exaggeration = exaggeration;
  options.cache_bytes = size_t{1} << 30;
  options.render.max_fps = 30;
  auto station = context.ok() ? Station::Start(options, Clock::System(), std::move(*context))
                              : Result<std::unique_ptr<Station>>(context.status());
  if (!station.ok()) {
    fmt::print(stderr, "screen_error: {}\n", station.message());
    std::exit(1);
  }
  ViewParameters view;
  view.view = kView;
  view.number = 1;
  view.eye_ecef = ToEcef({0, 0, 2e7});
  view.width_px = kWidth_px;
  view.height_px = kHeight_px;
  view.error_px = bound_px;
  view.exaggeration = exaggeration;
  view.image_layers = UsesOf(*(*station)->ImageLayers({}));
  view.sky = view.hud = view.labels = view.draw_objects = false;
  ViewChannel& channel = (*station)->AddView(view, nullptr);
  FullSurface surface(dataset, exaggeration);
  figures::Poses chance(dataset, 2);
  std::vector<double> all;
  for (int pose = 0; pose < poses; ++pose) {
    const Geodetic place = chance.PlaceOf(pose);
    const double ground_m = std::max(0.0, surface.HeightAt(place));
    const double height_m = ground_m + exaggeration * std::pow(10.0, chance.Uniform(2.3, 5.5));
    view.eye_ecef = ToEcef({place.latitude_deg, place.longitude_deg, height_m});
    view.ecef_from_camera = chance.AxesAt(place, -80, 0);
    view.time_s = Clock::System().NowSeconds();
    ++view.number;
    Errors errors = Measure(Settled(**station, channel, view), surface, bound_px);
    if (errors.px.empty()) continue;
    const double worst = *std::max_element(errors.px.begin(), errors.px.end());
    fmt::print(
        "x{:<2} pose {:3} at {:8.3f} {:9.3f}, {:9.0f} m over ground: {:6} points, worst {:.3f} px{}\n", exaggeration,
        pose, place.latitude_deg, place.longitude_deg, height_m - ground_m, errors.px.size(), worst,
        worst <= bound_px + kOverBound_px
            ? ""
            : fmt::format(" at {:.6f} {:.6f}", errors.worst_place.latitude_deg, errors.worst_place.longitude_deg));
    std::fflush(stdout);
    all.insert(all.end(), errors.px.begin(), errors.px.end());
  }
  std::sort(all.begin(), all.end());
  const auto within = std::upper_bound(all.begin(), all.end(), bound_px + kOverBound_px) - all.begin();
  fmt::print(
      "exaggeration {}: {} poses, {} points, bound {} px: {:.5f} % within the bound + {} px, median {:.3f}, worst "
      "{:.3f} px\n",
      exaggeration, poses, all.size(), bound_px, 100.0 * static_cast<double>(within) / static_cast<double>(all.size()),
      kOverBound_px, all[all.size() / 2], all.back());
  return all.back();
}

}  // namespace
}  // namespace belvedere

int main(int argc, char** argv) {
  using namespace belvedere;
  const int poses = argc > 2 ? std::atoi(argv[2]) : 200;
  const double bound_px = argc > 3 ? std::atof(argv[3]) : 1.0;
  if (argc < 2 || argc > 4 || poses < 2 || !(bound_px > 0)) {
    fmt::print(stderr, "usage: {} DATASET [POSES [BOUND_PX]]\n", argv[0]);
    return 2;
  }
  const auto dataset = Dataset::Open(argv[1]);
  if (!dataset.ok()) {
    fmt::print(stderr, "screen_error: {}\n", dataset.message());
    return 1;
  }
  const double plain = Run(**dataset, argv[1], (poses + 1) / 2, bound_px, 1);
  const double exaggerated = Run(**dataset, argv[1], poses / 2, bound_px, 10);
  return std::max(plain, exaggerated) <= bound_px + kOverBound_px ? 0 : 1;
}

#include "runtime/app/overview.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kHeightInSpans = 10.0;
constexpr double kLowest_m = 50e3;
constexpr int kPanRefinements = 12;

Overview Within(Overview overview) {
  overview.latitude_deg = std::clamp(overview.latitude_deg, -kOverviewNorthernmost_deg, kOverviewNorthernmost_deg);
  overview.longitude_deg = std::remainder(overview.longitude_deg, 360.0);
  overview.span_m = std::clamp(overview.span_m, kLeastSpan_m, kWidestSpan_m);
  return overview;
}

}  // namespace

Camera CameraOf(const Overview& overview) {
  const double height_m = std::max(kHeightInSpans * overview.span_m, kLowest_m);
  return Camera::At({overview.latitude_deg, overview.longitude_deg, height_m}, 0, -90);
}

Geodetic PlaceUnder(const Overview& overview, const Lens& lens, const PicturePoint& point) {
  const Camera camera = CameraOf(overview);
  const double metres_per_pixel = overview.span_m / lens.height_px;
  const double right_m = (point.x_px - 0.5 * lens.width_px) * metres_per_pixel;
  const double up_m = (0.5 * lens.height_px - point.y_px) * metres_per_pixel;
  const SightLine line{camera.eye_ecef + camera.ecef_from_camera[0] * right_m + camera.ecef_from_camera[1] * up_m,
                       camera.forward()};
  const auto distance = DistanceToEllipsoid(line, 0);
  Geodetic place = ToGeodetic(distance ? line.origin_ecef + line.direction * *distance : NearestOnLimb(line));
  place.height_m = 0;
  return place;
}

Overview Panned(const Overview& overview, const Lens& lens, const Geodetic& held, const PicturePoint& to) {
  Overview panned = overview;
  for (int i = 0; i < kPanRefinements; ++i) {
    const Geodetic under = PlaceUnder(panned, lens, to);
    panned.latitude_deg += held.latitude_deg - under.latitude_deg;
    panned.longitude_deg += std::remainder(held.longitude_deg - under.longitude_deg, 360.0);
    panned = Within(panned);
  }
  return panned;
}

Overview Zoomed(const Overview& overview, const Lens& lens, const PicturePoint& at, double steps) {
  const Geodetic held = PlaceUnder(overview, lens, at);
  Overview zoomed = overview;
  zoomed.span_m = overview.span_m * std::pow(1.0 - kZoomShare, steps);
  return Panned(Within(zoomed), lens, held, at);
}

}  // namespace belvedere

#include "managers/ground_bounds.h"

#include "runtime/earth/post_grid.h"
#include "runtime/earth/units.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

constexpr int kBoxLevel = 4;
constexpr double kLargestCurvature_m = 6'400'000.0;  // radius of curvature of the ellipsoid, at most
constexpr double kLeastBent_deg = 5;                 // as wide a quadnode must be for its hull to be worth its making

}  // namespace

bool GroundBounds::AreWorthTheirMaking(Quadcode node) {
  return node.level() >= kBoxLevel || node.Doublings() > 0;
}

GroundBounds::GroundBounds(const TerrainPage& page) {
  const GeoBox box = page.node.Box();
  const double latitude_deg = 0.5 * (box.south_deg + box.north_deg);
  const double longitude_deg = 0.5 * (box.west_deg + box.east_deg);
  axes_ = LevelAxesAt(latitude_deg, longitude_deg);
  const double half_width = 0.5 * page.node.WidthDegrees() * kRadiansPerDegree;
  const double half_height = 0.5 * page.node.HeightDegrees() * kRadiansPerDegree;
  const double high_m = page.max_height_m;
  const double low_m = page.min_height_m;
  const double radius = kLargestCurvature_m + std::max(0.0, high_m);
  const double east = 0.5 * WidthOnGroundDegrees(page.node) * kRadiansPerDegree * radius;
  // Parallels bend towards the pole, and leave the box's middle line by this at its sides.
  const double north = half_height * radius + east * std::tan(0.5 * half_width);
  const double drop = (east * east + north * north) / (2.0 * kPolarRadius_m);  // of the rim below the middle
  half_ = {east, north, 0.5 * (high_m - low_m + drop)};
  center_ecef_ = ToEcef({latitude_deg, longitude_deg, 0.5 * (high_m + low_m - drop)});
  if (page.node.Doublings() > 0 && page.node.WidthDegrees() >= kLeastBent_deg) MakeHull(page, box);
}

void GroundBounds::MakeHull(const TerrainPage& page, const GeoBox& box) {
  const bool northern = box.south_deg > 0;
  const double longer_deg = northern ? box.south_deg : box.north_deg;  // parallel
  const double shorter_deg = northern ? box.north_deg : box.south_deg;
  // Of the longer arc two tangents at its ends and one at its middle: they meet a quarter of it from either end.
  const double quarter_deg = 0.25 * page.node.WidthDegrees();
  const double outwards = 1.0 / std::cos(quarter_deg * kRadiansPerDegree);
  const double across_m =
      std::hypot(WidthOnGroundDegrees(page.node), page.node.HeightDegrees()) * kRadiansPerDegree * kLargestCurvature_m;
  const double bulge_m = across_m * across_m / (8.0 * kPolarRadius_m);  // of the ground over its chords
  for (const double height_m : {double{page.min_height_m}, page.max_height_m + bulge_m}) {
    for (const double longitude_deg : {box.west_deg, box.east_deg}) {
      hull_ecef_[hull_points_++] = ToEcef({longer_deg, longitude_deg, height_m});
      hull_ecef_[hull_points_++] = ToEcef({shorter_deg, longitude_deg, height_m});
    }
    for (const double longitude_deg : {box.west_deg + quarter_deg, box.east_deg - quarter_deg}) {
      const glm::dvec3 on_arc = ToEcef({longer_deg, longitude_deg, height_m});
      hull_ecef_[hull_points_++] = {outwards * on_arc.x, outwards * on_arc.y, on_arc.z};
    }
  }
}

double GroundBounds::DistanceTo(const glm::dvec3& ecef) const {
  const glm::dvec3 away = ecef - center_ecef_;
  const glm::dvec3 along(glm::dot(away, axes_.east), glm::dot(away, axes_.north), glm::dot(away, axes_.up));
  return glm::length(glm::max(glm::abs(along) - half_, glm::dvec3(0)));
}

double GroundBounds::LeastAlong(const glm::dvec3& from, const glm::dvec3& direction) const {
  const glm::dvec3 along(glm::dot(direction, axes_.east), glm::dot(direction, axes_.north),
                         glm::dot(direction, axes_.up));
  const double of_box = glm::dot(center_ecef_ - from, direction) - glm::dot(glm::abs(along), half_);
  if (hull_points_ == 0) return of_box;
  double of_hull = std::numeric_limits<double>::max();
  for (size_t i = 0; i < hull_points_; ++i) of_hull = std::min(of_hull, glm::dot(hull_ecef_[i] - from, direction));
  return std::max(of_box, of_hull);
}

}  // namespace belvedere

#include "managers/watch_outline.h"

#include "managers/effects.h"
#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace belvedere {
namespace {

constexpr double kLift_m = 1.0;
constexpr double kLiftShare = 0.003;  // of the distance from the eye
constexpr float kWidth_px = 1.2F;
constexpr std::array<uint8_t, 4> kColour{255, 214, 64, 230};

}  // namespace

WatchOutlines::Rim WatchOutlines::RimOf(const WatchArea& area, const GroundHeight& ground) {
  const double from_centre_m = glm::length(area.centre_ecef);
  const glm::dvec3 up = area.centre_ecef / from_centre_m;
  const glm::dvec3 aside = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 east = glm::normalize(glm::cross(aside, up)), north = glm::cross(up, east);
  const double angle = 2 * std::asin(std::min(1.0, 0.5 * area.radius_m / from_centre_m));
  Rim rim;
  for (size_t i = 0; i < rim.size(); ++i) {
    const double around = 2 * M_PI * static_cast<double>(i) / static_cast<double>(rim.size());
    const glm::dvec3 outward = std::cos(around) * north + std::sin(around) * east;
    Geodetic place = ToGeodetic(from_centre_m * (std::cos(angle) * up + std::sin(angle) * outward));
    place.height_m = ground(place.latitude_deg, place.longitude_deg);
    rim[i] = ToEcef(place);
  }
  return rim;
}

void WatchOutlines::Add(const Areas& areas, const glm::dvec3& eye_ecef, double now_s, const GroundHeight& ground,
                        std::vector<EffectInstance>& effects) {
  if (AreDue(areas, now_s)) {
    areas_ = areas;
    due_s_ = now_s + kRimHolds_s;
    rims_.clear();
    for (size_t i = 0; areas != nullptr && i < areas->size(); ++i) {
      const WatchArea& area = (*areas)[i];
      if (area.centre_ecef != glm::dvec3(0.0) && area.radius_m > 0) rims_.push_back(RimOf(area, ground));
    }
  }
  const auto lifted = [&](const glm::dvec3& point) {
    return point + (kLift_m + kLiftShare * glm::distance(point, eye_ecef)) * glm::normalize(point);
  };
  for (const Rim& rim : rims_) {
    if (effects.size() + kRimPieces > kMostEffects) break;
    for (size_t i = 0; i < rim.size(); ++i)
      effects.push_back(ThinLine(lifted(rim[i]), lifted(rim[(i + 1) % rim.size()]), kWidth_px, kColour, kColour));
  }
}

}  // namespace belvedere

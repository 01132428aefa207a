#include "managers/watch_outline.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace belvedere {
namespace {

constexpr double kLift_m = 1.0;
constexpr double kLiftShare = 0.003;  // of the distance from the eye
constexpr float kWidth_px = 1.2F;
constexpr std::array<uint8_t, 4> kColour{255, 214, 64, 230};

}  // namespace

void AddOutline(const WatchArea& area, const glm::dvec3& eye_ecef, const RimHeight& height,
                std::vector<EffectInstance>& effects) {
  const double from_centre_m = glm::length(area.centre_ecef);
  if (!(from_centre_m > 0) || !(area.radius_m > 0)) return;
  const glm::dvec3 up = area.centre_ecef / from_centre_m;
  const glm::dvec3 aside = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 east = glm::normalize(glm::cross(aside, up)), north = glm::cross(up, east);
  const double angle = 2 * std::asin(std::min(1.0, 0.5 * area.radius_m / from_centre_m));
  const auto rim_at = [&](int piece) {
    const double around = 2 * M_PI * piece / kRimPieces;
    const glm::dvec3 outward = std::cos(around) * north + std::sin(around) * east;
    Geodetic place = ToGeodetic(from_centre_m * (std::cos(angle) * up + std::sin(angle) * outward));
    place.height_m = height(place.latitude_deg, place.longitude_deg);
    const glm::dvec3 ground = ToEcef(place);
    return ground + (kLift_m + kLiftShare * glm::distance(ground, eye_ecef)) * glm::normalize(ground);
  };
  glm::dvec3 from = rim_at(0);
  for (int i = 1; i <= kRimPieces; ++i) {
    EffectInstance& piece = effects.emplace_back();
    piece.from_ecef = from;
    piece.to_ecef = from = rim_at(i % kRimPieces);
    piece.from_m = piece.to_m = 0;
    piece.least_px = kWidth_px;
    piece.from_colour = piece.to_colour = kColour;
    piece.shape = EffectInstance::Shape::kLine;
  }
}

}  // namespace belvedere

#include "managers/footing.h"

#include "runtime/earth/geoid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

constexpr double kUnseen_s = 1.0;  // after that nobody remembers how high it stood

}  // namespace

Footing FootingOf(const EntityType& type) {
  const bool platform = type.kind == EntityType::kPlatform;
  if (type.domain == EntityType::kLand && (platform || type.kind == EntityType::kLifeForm)) return Footing::kGround;
  return platform && type.domain == EntityType::kSurface ? Footing::kSea : Footing::kNone;
}

double SeaHeight(double latitude_deg, double longitude_deg) {
  static const Result<std::shared_ptr<const Geoid>> kGeoid = Geoid::LoadEgm96();
  if (!kGeoid.ok()) return 0;
  const double height_m = (*kGeoid)->Height(latitude_deg, longitude_deg);
  return std::isfinite(height_m) ? height_m : 0;
}

GroundPoint GroundBlend::Show(const GroundPoint& ground, double now_s) {
  if (now_s - last_s_ > kUnseen_s) {
    begun_s_ = -1e9;
  } else if (ground.level != level_) {
    off_m_ = shown_m_ - ground.height_m;
    off_normal_ = shown_normal_ - ground.normal_ecef;
    begun_s_ = now_s;
  }
  level_ = ground.level;
  last_s_ = now_s;
  GroundPoint shown = ground;
  const double u = std::clamp((now_s - begun_s_) / kGroundBlend_s, 0.0, 1.0);
  if (u < 1.0) {
    const double left = 1.0 - u * u * (3.0 - 2.0 * u);
    shown.height_m += left * off_m_;
    shown.normal_ecef = glm::normalize(shown.normal_ecef + left * off_normal_);
  }
  shown_m_ = shown.height_m;
  shown_normal_ = shown.normal_ecef;
  return shown;
}

}  // namespace belvedere

#include "managers/effects.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

using Colour = std::array<uint8_t, 4>;
using Shape = EffectInstance::Shape;

constexpr Colour kFire{255, 150, 40, 220}, kFireCore{255, 225, 140, 255}, kWhite{255, 255, 245, 255};

bool Bit(uint32_t appearance, int bit) {
  return (appearance >> bit & 1) != 0;
}

Colour WithAlpha(Colour colour, double share) {
  colour[3] = static_cast<uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * colour[3]));
  return colour;
}

// 0..1, the same for the same numbers.
double Noise(uint64_t seed, uint64_t index) {
  uint64_t z = seed * 0x9E3779B97F4A7C15u + index * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

void AddRound(const glm::dvec3& at, const glm::dvec3& velocity, double radius_m, Colour colour, Shape shape,
              std::vector<EffectInstance>& effects, float least_px = 0) {
  EffectInstance& effect = effects.emplace_back();
  effect.from_ecef = effect.to_ecef = at;
  effect.velocity_mps = velocity;
  effect.from_m = effect.to_m = static_cast<float>(radius_m);
  effect.least_px = least_px;
  effect.from_colour = effect.to_colour = colour;
  effect.shape = shape;
}

// Puffs that come out of an object one after the other and stay behind, rise, grow and thin out.
struct Plume {
  Colour colour{};
  Shape shape = Shape::kPuff;
  double every_s = 0.5, life_s = 6;
  double radius_m = 1, growth = 3;  // at the start; how many times larger at the end
  double rise_mps = 2;
  glm::dvec3 source_body{0.0};
};

void AddPlume(const Plume& plume, const ObjectInstance& object, uint64_t seed, double now_s,
              std::vector<EffectInstance>& effects) {
  const glm::dvec3 up = glm::normalize(object.position_ecef);
  const glm::dvec3 source = object.position_ecef + object.ecef_from_body * plume.source_body;
  const auto newest = static_cast<int64_t>(std::floor(now_s / plume.every_s));
  const auto puffs = static_cast<int64_t>(plume.life_s / plume.every_s);
  for (int64_t k = newest - puffs + 1; k <= newest; ++k) {
    const double age_s = now_s - static_cast<double>(k) * plume.every_s;
    const double share = age_s / plume.life_s;
    const auto index = static_cast<uint64_t>(k);
    const double radius_m = plume.radius_m * (1 + plume.growth * share) * (0.8 + 0.4 * Noise(seed, index));
    const glm::dvec3 drift(Noise(seed, 3 * index) - 0.5, Noise(seed, 3 * index + 1) - 0.5,
                           Noise(seed, 3 * index + 2) - 0.5);
    const glm::dvec3 rise = plume.rise_mps * up;
    const glm::dvec3 at = source - age_s * object.velocity_mps + age_s * rise + (plume.radius_m * share) * drift;
    AddRound(at, rise, radius_m, WithAlpha(plume.colour, (1 - share) * std::min(1.0, 4 * share + 0.25)), plume.shape,
             effects);
  }
}

// A band that an object leaves behind in a straight line, wide and thin at its end.
void AddWake(const glm::dvec3& source, const glm::dvec3& velocity, double length_s, double from_m, double to_m,
             Colour colour, std::vector<EffectInstance>& effects) {
  EffectInstance& effect = effects.emplace_back();
  effect.from_ecef = source;
  effect.to_ecef = source - length_s * velocity;
  effect.velocity_mps = velocity;
  effect.from_m = static_cast<float>(from_m);
  effect.to_m = static_cast<float>(to_m);
  effect.from_colour = colour;
  effect.to_colour = WithAlpha(colour, 0);
}

void AddLight(const ObjectInstance& object, const glm::dvec3& at_body, Colour colour, double radius_m, double strength,
              std::vector<EffectInstance>& effects) {
  constexpr float kLeast_px = 2.0F;
  AddRound(object.position_ecef + object.ecef_from_body * at_body, object.velocity_mps, radius_m,
           WithAlpha(colour, strength), Shape::kGlow, effects, kLeast_px);
}

void AddLights(const SeenAppearance& seen, const ObjectInstance& object, uint64_t seed, const EffectMoment& moment,
               std::vector<EffectInstance>& effects) {
  constexpr Colour kRed{255, 40, 30, 255}, kGreen{40, 255, 80, 255}, kWarm{255, 235, 190, 255};
  const double r = object.radius_m, strength = 1.0 - 0.75 * moment.day;
  const double size = std::clamp(0.06 * r, 0.15, 1.2);
  if (seen.navigation_lights || seen.running_lights) {
    AddLight(object, {0, -0.85 * r, 0}, kRed, size, strength, effects);
    AddLight(object, {0, 0.85 * r, 0}, kGreen, size, strength, effects);
    AddLight(object, {-0.9 * r, 0, 0}, kWhite, size, strength, effects);
  }
  // One flash of a tenth of a second each second, not all aircraft at once.
  const double beat = moment.now_s + Noise(seed, 0);
  if (seen.anti_collision_lights && beat - std::floor(beat) < 0.12) {
    AddLight(object, {0, 0, -0.25 * r}, kRed, 2 * size, strength, effects);
  }
  if (seen.landing_lights) AddLight(object, {0.8 * r, 0, 0.1 * r}, kWarm, 2 * size, strength, effects);
  for (const double side : {-0.3 * r, 0.3 * r}) {
    if (seen.head_lights) AddLight(object, {0.9 * r, side, -0.25 * r}, kWarm, 2 * size, strength, effects);
    if (seen.tail_lights) AddLight(object, {-0.9 * r, side, -0.25 * r}, kRed, size, 0.6 * strength, effects);
    if (seen.brake_lights) AddLight(object, {-0.9 * r, side, -0.25 * r}, kRed, 2 * size, strength, effects);
  }
}

void AddTrailOfKind(int trail, const EntityType& type, const ObjectInstance& object, uint64_t seed, double now_s,
                    std::vector<EffectInstance>& effects) {
  const double r = object.radius_m, size = trail;  // 1 small to 3 large
  const glm::dvec3 tail = object.position_ecef + object.ecef_from_body * glm::dvec3(-0.9 * r, 0, 0);
  if (glm::length(object.velocity_mps) < 0.5) return;
  if (type.is_ground_platform()) {
    AddPlume({.colour = {176, 152, 118, 130},
              .every_s = 0.3,
              .life_s = 2 + size,
              .radius_m = 0.25 * r * size,
              .growth = 2.5,
              .rise_mps = 0.6,
              .source_body = {-0.9 * r, 0, 0}},
             object, seed, now_s, effects);
  } else if (type.kind == EntityType::kPlatform && type.domain == EntityType::kSurface) {
    AddWake(tail, object.velocity_mps, 10 + 10 * size, 0.15 * r, 0.3 * r * size, {235, 245, 250, 170}, effects);
  } else {
    for (const double side : {-0.25 * r, 0.25 * r}) {
      AddWake(tail + object.ecef_from_body * glm::dvec3(0, side, 0), object.velocity_mps, 8 * size, 0.04 * r,
              0.25 * r * size, {245, 248, 255, 190}, effects);
    }
  }
}

}  // namespace

SeenAppearance AppearanceOf(const EntityType& type, uint32_t appearance) {
  SeenAppearance seen;
  const bool platform = type.kind == EntityType::kPlatform;
  if (!platform && type.kind != EntityType::kMunition) return seen;  // other kinds give these bits other meanings
  seen.smoke = Bit(appearance, 5);
  seen.engine_smoke = Bit(appearance, 6);
  seen.trail = static_cast<int>(appearance >> 7 & 3);
  seen.flames = Bit(appearance, 15);
  if (!platform) {
    seen.afterburner = Bit(appearance, 16);  // launch flash
    return seen;
  }
  switch (type.domain) {
    case EntityType::kLand:
      seen.head_lights = Bit(appearance, 12);
      seen.tail_lights = Bit(appearance, 13);
      seen.brake_lights = Bit(appearance, 14);
      break;
    case EntityType::kAir:
      seen.landing_lights = Bit(appearance, 12);
      seen.navigation_lights = Bit(appearance, 13);
      seen.anti_collision_lights = Bit(appearance, 14);
      seen.afterburner = Bit(appearance, 16);
      break;
    case EntityType::kSurface: seen.running_lights = Bit(appearance, 12); break;
    case EntityType::kSubsurface:
      seen.trail = 0;
      seen.running_lights = Bit(appearance, 12);
      break;
    default: break;
  }
  return seen;
}

float ShadeOfDamage(uint32_t damage) {
  constexpr std::array<float, 4> kShades = {1.0F, 0.8F, 0.55F, 0.25F};
  return kShades[damage & 3];
}

void AddAppearance(const SeenAppearance& seen, const EntityType& type, const ObjectInstance& object, uint64_t seed,
                   const EffectMoment& moment, std::vector<EffectInstance>& effects) {
  const double r = object.radius_m;
  if (seen.trail > 0) AddTrailOfKind(seen.trail, type, object, seed, moment.now_s, effects);
  if (seen.smoke) {
    AddPlume({.colour = {38, 36, 34, 190},
              .every_s = 0.5,
              .life_s = 8,
              .radius_m = 0.3 * r,
              .growth = 4,
              .rise_mps = 0.35 * r,
              .source_body = {0, 0, -0.2 * r}},
             object, seed, moment.now_s, effects);
  }
  if (seen.engine_smoke) {
    AddPlume({.colour = {92, 90, 88, 140},
              .every_s = 0.4,
              .life_s = 3,
              .radius_m = 0.15 * r,
              .growth = 3,
              .rise_mps = 0.1 * r,
              .source_body = {-0.8 * r, 0, 0}},
             object, seed + 1, moment.now_s, effects);
  }
  if (seen.flames) {
    AddPlume({.colour = kFire,
              .shape = Shape::kGlow,
              .every_s = 0.12,
              .life_s = 0.9,
              .radius_m = 0.3 * r,
              .growth = 0.3,
              .rise_mps = 0.7 * r,
              .source_body = {0, 0, -0.1 * r}},
             object, seed + 2, moment.now_s, effects);
  }
  if (seen.afterburner) {
    EffectInstance& flame = effects.emplace_back();
    flame.from_ecef = object.position_ecef + object.ecef_from_body * glm::dvec3(-0.8 * r, 0, 0);
    flame.to_ecef = object.position_ecef + object.ecef_from_body * glm::dvec3(-1.5 * r, 0, 0);
    flame.velocity_mps = object.velocity_mps;
    flame.from_m = static_cast<float>(0.09 * r);
    flame.to_m = static_cast<float>(0.03 * r);
    flame.from_colour = kFireCore;
    flame.to_colour = WithAlpha(kFire, 0.1);
    flame.shape = Shape::kGlow;
  }
  AddLights(seen, object, seed, moment, effects);
}

namespace {

void AddExplosion(const SceneEvent& event, double age_s, std::vector<EffectInstance>& effects) {
  constexpr double kFire_s = 0.9, kSmoke_s = 9;
  constexpr int kPuffs = 10;
  const glm::dvec3 up = glm::normalize(event.position_ecef);
  const double r = event.size_m;
  for (int i = 0; i < kPuffs; ++i) {
    const auto index = static_cast<uint64_t>(i);
    const glm::dvec3 way(Noise(event.number, 3 * index) - 0.5, Noise(event.number, 3 * index + 1) - 0.5,
                         Noise(event.number, 3 * index + 2) - 0.5);
    const double spread = 1.0 - std::exp(-4.0 * age_s);
    if (age_s < kSmoke_s) {
      const double share = age_s / kSmoke_s;
      const glm::dvec3 at = event.position_ecef + 1.3 * r * spread * way + (0.25 * r * age_s) * up;
      AddRound(at, 0.25 * r * up, r * (0.35 + 0.9 * share),
               WithAlpha({60, 56, 52, 200}, (1 - share) * std::min(1.0, 3 * age_s)), Shape::kPuff, effects);
    }
    if (age_s < kFire_s) {
      const double share = age_s / kFire_s;
      AddRound(event.position_ecef + r * spread * way, {}, r * (0.3 + 0.5 * spread) * (1 - 0.5 * share),
               WithAlpha(i % 3 == 0 ? kFireCore : kFire, 1 - share), Shape::kGlow, effects, 3);
    }
  }
}

void AddScorch(const SceneEvent& event, double now_s, const EffectGround& ground,
               std::vector<EffectInstance>& effects) {
  constexpr double kFades_s = 10, kLift_m = 0.2;
  Geodetic place = ToGeodetic(event.position_ecef);
  place.height_m = ground.height_m + kLift_m;
  EffectInstance& mark = effects.emplace_back();
  mark.from_ecef = ToEcef(place);
  mark.to_ecef = mark.from_ecef + ground.normal_ecef;
  mark.from_m = mark.to_m = event.size_m;
  mark.from_colour = mark.to_colour = WithAlpha({22, 18, 14, 210}, (event.end_s - now_s) / kFades_s);
  mark.shape = Shape::kDisc;
}

}  // namespace

void AddEvent(const SceneEvent& event, double now_s, const std::optional<EffectGround>& ground,
              std::vector<EffectInstance>& effects) {
  if (now_s < event.start_s || now_s >= event.end_s) return;
  const double age_s = now_s - event.start_s, share = age_s / (event.end_s - event.start_s);
  switch (event.kind) {
    case SceneEvent::Kind::kMuzzleFlash:
    case SceneEvent::Kind::kCollision:
      AddRound(event.position_ecef, event.velocity_mps, event.size_m, WithAlpha(kFireCore, 1 - share), Shape::kGlow,
               effects, 3);
      break;
    case SceneEvent::Kind::kTracer: {
      EffectInstance& streak = effects.emplace_back();
      const glm::dvec3 at = event.position_ecef + age_s * event.velocity_mps;
      streak.from_ecef = at;
      streak.to_ecef = at - std::min(0.04, age_s) * event.velocity_mps;
      streak.velocity_mps = event.velocity_mps;
      streak.from_m = streak.to_m = event.size_m;
      streak.least_px = 1.2F;
      streak.from_colour = kFireCore;
      streak.to_colour = WithAlpha(kFire, 0.2);
      streak.shape = Shape::kGlow;
      break;
    }
    case SceneEvent::Kind::kExplosion: AddExplosion(event, age_s, effects); break;
    case SceneEvent::Kind::kDust: {
      const glm::dvec3 up = glm::normalize(event.position_ecef);
      AddRound(event.position_ecef + (0.3 * event.size_m * age_s) * up, 0.3 * event.size_m * up,
               event.size_m * (0.4 + 0.8 * share), WithAlpha({176, 152, 118, 170}, 1 - share), Shape::kPuff, effects);
      break;
    }
    case SceneEvent::Kind::kScorch:
      if (ground) AddScorch(event, now_s, *ground, effects);
      break;
  }
}

EffectInstance ThinLine(const glm::dvec3& from_ecef, const glm::dvec3& to_ecef, float width_px,
                        const std::array<uint8_t, 4>& from_colour, const std::array<uint8_t, 4>& to_colour) {
  EffectInstance line;
  line.from_ecef = from_ecef;
  line.to_ecef = to_ecef;
  line.from_m = line.to_m = 0;
  line.least_px = width_px;
  line.from_colour = from_colour;
  line.to_colour = to_colour;
  line.shape = Shape::kLine;
  return line;
}

void AddTrail(std::span<const TrackPoint> track, const ObjectInstance& object, double now_s, double longest_s,
              std::vector<EffectInstance>& effects) {
  constexpr float kWidth_px = 0.9F;
  glm::dvec3 from = object.position_ecef;
  double from_s = now_s;
  for (size_t i = track.size(); i-- > 0;) {
    const TrackPoint& point = track[i];
    if (point.time_s < now_s - longest_s) return;
    const auto colour_at = [&](double time_s) {
      return WithAlpha(object.look.colour, 0.8 * (1 - (now_s - time_s) / longest_s));
    };
    effects.push_back(ThinLine(from, point.position_ecef, kWidth_px, colour_at(from_s), colour_at(point.time_s)));
    from = point.position_ecef;
    from_s = point.time_s;
  }
}

void AddVector(const KinematicState& state, const ObjectInstance& object, double now_s, double ahead_s,
               std::vector<EffectInstance>& effects) {
  constexpr int kPieces = 4;
  constexpr float kWidth_px = 0.9F;
  if (glm::length(object.velocity_mps) < kStationary_mps) return;
  const glm::dvec3 off = object.position_ecef - PoseAt(state, now_s).position_ecef;  // smoothed, or stood on the ground
  const Colour colour = WithAlpha(object.look.colour, 0.9);
  glm::dvec3 from = object.position_ecef;
  for (int i = 1; i <= kPieces; ++i) {
    const glm::dvec3 to = PoseAt(state, now_s + ahead_s * i / kPieces).position_ecef + off;
    effects.push_back(ThinLine(from, to, kWidth_px, colour, colour));
    effects.back().velocity_mps = object.velocity_mps;
    from = to;
  }
}

}  // namespace belvedere

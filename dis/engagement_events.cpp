#include "dis/engagement_events.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace belvedere::dis {
namespace {

// SISO-REF-010, "Detonation result".
enum Result : uint8_t {
  kGroundImpact = 3,
  kGroundProximate = 4,
  kNoDetonation = 6,
  kHeHitSmall = 7,
  kHeHitMedium = 8,
  kHeHitLarge = 9,
  kDirtBlastSmall = 11,
  kDirtBlastMedium = 12,
  kDirtBlastLarge = 13,
};

constexpr double kFlash_s = 0.12, kTracer_s = 2.0, kLongestTracer_s = 5.0, kExplosion_s = 9.0, kDust_s = 2.0;
constexpr double kSlowestTracer_mps = 50.0;
constexpr float kTracerRadius_m = 0.12F;

// Radius of the fire. Category of a munition: 1 guided, 2 ballistic, 3 fixed.
float SizeOf(const MunitionDescriptor& descriptor) {
  constexpr uint8_t kGuided = 1, kBallistic = 2;
  if (descriptor.type.category == kGuided) return 10.0F;
  if (descriptor.type.category == kBallistic && descriptor.warhead == 0) return 1.0F;  // no explosive: a bullet
  return 7.0F;
}

float SizeOf(const Detonation& detonation) {
  switch (detonation.result) {
    case kHeHitSmall:
    case kDirtBlastSmall: return 3.0F;
    case kHeHitMedium:
    case kDirtBlastMedium: return 7.0F;
    case kHeHitLarge:
    case kDirtBlastLarge: return 14.0F;
    default: return SizeOf(detonation.descriptor);
  }
}

bool OnGround(uint8_t result) {
  return result == kGroundImpact || result == kGroundProximate ||
         (result >= kDirtBlastSmall && result <= kDirtBlastLarge);
}

}  // namespace

std::vector<SceneEvent> EventsOf(const Fire& fire, double now_s) {
  std::vector<SceneEvent> events;
  const float size_m = SizeOf(fire.descriptor);
  events.push_back({.kind = SceneEvent::Kind::kMuzzleFlash,
                    .position_ecef = fire.position_ecef,
                    .velocity_mps = {},
                    .size_m = std::clamp(0.4F * size_m, 0.5F, 4.0F),
                    .start_s = now_s,
                    .end_s = now_s + kFlash_s});
  const double speed_mps = glm::length(glm::dvec3(fire.velocity_mps));
  const bool flies_as_entity = fire.munition.entity != 0;  // its own Entity States show it
  if (speed_mps < kSlowestTracer_mps || flies_as_entity) return events;
  const double flight_s = fire.range_m > 0 ? static_cast<double>(fire.range_m) / speed_mps : kTracer_s;
  events.push_back({.kind = SceneEvent::Kind::kTracer,
                    .position_ecef = fire.position_ecef,
                    .velocity_mps = glm::dvec3(fire.velocity_mps),
                    .size_m = kTracerRadius_m,
                    .start_s = now_s,
                    .end_s = now_s + std::min(flight_s, kLongestTracer_s)});
  return events;
}

std::vector<SceneEvent> EventsOf(const Detonation& detonation, double now_s, double scorch_s) {
  std::vector<SceneEvent> events;
  const float size_m = SizeOf(detonation);
  const bool explodes = detonation.result != kNoDetonation && size_m > 2.0F;
  events.push_back({.kind = explodes ? SceneEvent::Kind::kExplosion : SceneEvent::Kind::kDust,
                    .position_ecef = detonation.position_ecef,
                    .velocity_mps = {},
                    .size_m = size_m,
                    .start_s = now_s,
                    .end_s = now_s + (explodes ? kExplosion_s : kDust_s)});
  if (!explodes || !OnGround(detonation.result) || scorch_s <= 0) return events;
  events.push_back({.kind = SceneEvent::Kind::kScorch,
                    .position_ecef = detonation.position_ecef,
                    .velocity_mps = {},
                    .size_m = 0.8F * size_m,
                    .start_s = now_s,
                    .end_s = now_s + scorch_s});
  return events;
}

SceneEvent EventOf(const Collision& collision, const KinematicState& issuing, double now_s) {
  constexpr double kCollision_s = 0.5;
  const Pose pose = PoseAt(issuing, now_s);
  return {.kind = SceneEvent::Kind::kCollision,
          .position_ecef = pose.position_ecef + pose.ecef_from_body * glm::dvec3(collision.position_in_entity_m),
          .velocity_mps = {},
          .size_m = 3.0F,
          .start_s = now_s,
          .end_s = now_s + kCollision_s};
}

}  // namespace belvedere::dis

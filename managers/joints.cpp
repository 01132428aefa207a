#include "managers/joints.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace belvedere {
namespace {

enum PartClass : uint32_t { kLandingGear = 3072, kPrimaryTurret = 4096, kPrimaryGun = 4416 };
enum Metric : uint32_t {
  kPosition = 1,
  kExtension = 3,
  kAzimuth = 11,
  kAzimuthRate = 12,
  kElevation = 13,
  kElevationRate = 14
};
constexpr float kSpin_radps = 26;  // slow enough to be seen turning
constexpr uint32_t kPowerPlant = uint32_t{1} << 22, kGearDown = uint32_t{1} << 25;

std::optional<double> ValueOf(const ObjectRecord& record, uint32_t part_class, uint32_t metric) {
  for (const ArticulatedPart& part : record.parts()) {
    if (part.part_class() == part_class && part.metric() == metric && std::isfinite(part.value)) {
      return static_cast<double>(part.value);
    }
  }
  return std::nullopt;
}

// An angle that goes on by its rate.
float AngleOf(const ObjectRecord& record, uint32_t part_class, uint32_t metric, uint32_t rate, double since_s) {
  const double angle =
      ValueOf(record, part_class, metric).value_or(0) + since_s * ValueOf(record, part_class, rate).value_or(0);
  return static_cast<float>(std::remainder(angle, 2 * M_PI));
}

bool HatchOpen(uint32_t appearance) {
  return (appearance >> 9 & 7) >= 2;  // popped or open, with or without somebody
}

}  // namespace

JointsOf JointsAt(const ObjectRecord& record, double now_s) {
  JointsOf joints;
  if (!record.parts().empty()) {
    const double since_s = std::clamp(now_s - record.kinematics.time_s, 0.0, 60.0);
    joints.pose.turret_rad = AngleOf(record, kPrimaryTurret, kAzimuth, kAzimuthRate, since_s);
    joints.pose.gun_rad = AngleOf(record, kPrimaryGun, kElevation, kElevationRate, since_s);
  }
  if (record.type.is_air_platform()) {
    const auto gear = ValueOf(record, kLandingGear, kPosition);
    const double down =
        gear ? *gear : ValueOf(record, kLandingGear, kExtension).value_or((record.appearance & kGearDown) != 0 ? 1 : 0);
    joints.pose.open = static_cast<float>(std::clamp(down, 0.0, 1.0));
  } else if (record.type.is_ground_platform()) {
    joints.pose.open = HatchOpen(record.appearance) ? 0 : 1;
  }
  const bool runs = (record.appearance & kPowerPlant) != 0 && record.damage() < 3;
  if (!runs) return joints;
  joints.spin_radps = kSpin_radps;
  joints.pose.spin_rad = static_cast<float>(std::remainder(now_s * static_cast<double>(kSpin_radps), 2 * M_PI));
  return joints;
}

Posture PostureOf(const ObjectRecord& record, const glm::dmat3& ecef_from_body) {
  enum LifeFormState : uint32_t {
    kKneeling = 4,
    kProne = 5,
    kCrawling = 6,
    kSwimming = 7,
    kSitting = 10,
    kSquatting = 11,
    kCrouching = 12,
    kWading = 13
  };
  constexpr uint32_t kFatal = 3;
  if (record.type.kind != EntityType::kLifeForm) return {ecef_from_body, 0};
  const glm::dmat3 lying{ecef_from_body[2], ecef_from_body[1], -ecef_from_body[0]};  // head forward, front down
  if (record.damage() == kFatal) return {lying, 0};
  switch (record.appearance >> 16 & 15) {
    case kProne:
    case kCrawling:
    case kSwimming: return {lying, 0};
    case kKneeling: return {ecef_from_body, 0.45};
    case kSitting:
    case kSquatting: return {ecef_from_body, 0.7};
    case kCrouching: return {ecef_from_body, 0.3};
    case kWading: return {ecef_from_body, 0.6};
    default: return {ecef_from_body, 0};
  }
}

}  // namespace belvedere

#include "runtime/app/target.h"

#include <glm/geometric.hpp>

#include <limits>
#include <vector>

namespace belvedere {
namespace {

bool OfDomain(const ObjectRecord& object, uint8_t domain) {
  return object.visible() && object.type.kind == EntityType::kPlatform && object.type.domain == domain;
}

const ObjectRecord* Nearest(const ObjectSnapshot& snapshot, uint8_t domain, const glm::dvec3& start_ecef) {
  const ObjectRecord* nearest = nullptr;
  double least_m = std::numeric_limits<double>::infinity();
  for (const ObjectRecord& object : snapshot.objects) {
    if (!OfDomain(object, domain)) continue;
    const double distance_m = glm::distance(object.kinematics.position_ecef, start_ecef);
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = &object;
  }
  return nearest;
}

}  // namespace

std::optional<TargetRule> ParseTargetRule(std::string_view text) {
  using Kind = TargetRule::Kind;
  if (text.empty()) return std::nullopt;
  if (text == "first air") return TargetRule{Kind::kFirst, EntityType::kAir, {}, {}};
  if (text == "first ground") return TargetRule{Kind::kFirst, EntityType::kLand, {}, {}};
  if (text == "nearest air") return TargetRule{Kind::kNearest, EntityType::kAir, {}, {}};
  if (text == "nearest ground") return TargetRule{Kind::kNearest, EntityType::kLand, {}, {}};
  if (const auto id = EntityId::Parse(text)) return TargetRule{Kind::kId, 0, *id, {}};
  return TargetRule{Kind::kMarking, 0, {}, std::string(text)};
}

const ObjectRecord* ChooseTarget(const TargetRule& rule, const ObjectSnapshot& snapshot, const glm::dvec3& start_ecef) {
  using Kind = TargetRule::Kind;
  if (rule.kind == Kind::kId) return snapshot.Find(rule.id);
  if (rule.kind == Kind::kNearest) return Nearest(snapshot, rule.domain, start_ecef);
  for (const ObjectRecord& object : snapshot.objects) {
    if (rule.kind == Kind::kMarking ? object.marking.view() == rule.marking : OfDomain(object, rule.domain)) {
      return &object;
    }
  }
  return nullptr;
}

const ObjectRecord* NextTarget(const ObjectSnapshot& snapshot, EntityId current, int by) {
  const ObjectRecord* now = snapshot.Find(current);
  const uint8_t domain = now != nullptr ? now->type.domain : EntityType::kAir;
  std::vector<const ObjectRecord*> candidates;
  ptrdiff_t place = 0;
  for (const ObjectRecord& object : snapshot.objects) {
    if (!OfDomain(object, domain)) continue;
    if (object.id == current) place = static_cast<ptrdiff_t>(candidates.size());
    candidates.push_back(&object);
  }
  if (candidates.empty()) return nullptr;
  const auto count = static_cast<ptrdiff_t>(candidates.size());
  return candidates[static_cast<size_t>(((place + by) % count + count) % count)];
}

}  // namespace belvedere

#include "runtime/app/target_tracker.h"

#include "runtime/earth/ellipsoid.h"

namespace belvedere {

std::optional<Pose> TargetTracker::Follow(const std::string& rule_text, const TargetRule& rule,
                                          const glm::dvec3& start_ecef, const ObjectSnapshot& snapshot, double now_s,
                                          const GroundHeight& ground) {
  auto found = followed_.find(rule_text);
  const ObjectRecord* object = found == followed_.end() ? nullptr : snapshot.Find(found->second.id);
  if (object == nullptr) {
    object = ChooseTarget(rule, snapshot, start_ecef);
    if (object == nullptr) return std::nullopt;
    found = followed_.insert_or_assign(rule_text, Followed{object->id, {}}).first;
  }
  if (!object->visible()) return std::nullopt;
  Pose pose = found->second.smoother.Show(object->kinematics, object->report, now_s);
  if (object->type.is_ground_platform()) {
    Geodetic place = ToGeodetic(pose.position_ecef);
    place.height_m = ground(place.latitude_deg, place.longitude_deg);
    pose.position_ecef = ToEcef(place);
  }
  return pose;
}

void TargetTracker::Cycle(const std::string& rule_text, const ObjectSnapshot& snapshot, int by) {
  const auto found = followed_.find(rule_text);
  if (found == followed_.end()) return;
  const ObjectRecord* next = NextTarget(snapshot, found->second.id, by);
  if (next != nullptr) found->second = Followed{next->id, {}};
}

std::optional<EntityId> TargetTracker::IdOf(const std::string& rule_text) const {
  const auto found = followed_.find(rule_text);
  if (found == followed_.end()) return std::nullopt;
  return found->second.id;
}

}  // namespace belvedere

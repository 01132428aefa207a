// TargetTracker: finds the objects that views follow and says where they are now, smoothed as they are drawn.
//
// Views that name their target alike follow the same object, also when one of them goes on to the next.
//
// Threads: the UI thread.
#pragma once

#include "runtime/app/ground.h"
#include "runtime/app/target.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/object_table.h"

#include <map>
#include <optional>
#include <string>

namespace belvedere {

class TargetTracker {
 public:
  // The pose at now_s, which must not go back, of the object that the rule chose; nullopt while there is none. A ground
  // vehicle stands on the ground, as it is drawn.
  std::optional<Pose> Follow(const std::string& rule_text, const TargetRule& rule, const glm::dvec3& start_ecef,
                             const ObjectSnapshot& snapshot, double now_s, const GroundHeight& ground);
  void Cycle(const std::string& rule_text, const ObjectSnapshot& snapshot, int by);
  // Of the object that is followed, if any.
  std::optional<EntityId> IdOf(const std::string& rule_text) const;

 private:
  struct Followed {
    EntityId id;
    Smoother smoother;
  };
  std::map<std::string, Followed> followed_;
};

}  // namespace belvedere

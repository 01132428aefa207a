// TargetRule: which moving object a view follows, as a station file names it.
//
//   "first air", "first ground"      the one with the least entity id of that domain
//   "nearest air", "nearest ground"  the one nearest to where the view starts, when it is first chosen
//   "1:5001:12"                      the entity with that id
//   "UAL123"                         the entity with that marking
//
// Once chosen an object is kept for as long as it is known.
// Threads: pure functions.
#pragma once

#include "runtime/scene/object_table.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace belvedere {

struct TargetRule {
  enum class Kind : uint8_t { kFirst, kNearest, kId, kMarking };
  Kind kind = Kind::kFirst;
  uint8_t domain = EntityType::kAir;
  EntityId id;
  std::string marking;
};

// nullopt for an empty text.
std::optional<TargetRule> ParseTargetRule(std::string_view text);

// nullptr while no object fits. start_ecef: where the view starts.
const ObjectRecord* ChooseTarget(const TargetRule& rule, const ObjectSnapshot& snapshot, const glm::dvec3& start_ecef);

// The object `by` places after `current` among those of the same domain, in the order of ids and round the end.
const ObjectRecord* NextTarget(const ObjectSnapshot& snapshot, EntityId current, int by);

}  // namespace belvedere

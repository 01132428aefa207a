// EntityLooks: what an entity of some type looks like: which model of the catalogue, which symbol.
//
// Rules are tried in order; the first whose pattern fits wins. A type that no rule fits has no model and the symbol of
// its domain.
//
// Threads: read-only after it was made.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/entity.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace belvedere {

struct EntityLook {
  int model = -1;  // number in the model catalogue; -1 none
  SymbolShape symbol = SymbolShape::kOther;
  std::string name{};  // of that model
};

struct EntityRule {
  EntityPattern pattern;
  EntityLook look;
};

class EntityLooks {
 public:
  EntityLooks() = default;
  explicit EntityLooks(std::vector<EntityRule> rules) : rules_(std::move(rules)) {}
  // Valid as long as this.
  const EntityLook& LookOf(const EntityType& type) const;

 private:
  std::vector<EntityRule> rules_;
};

}  // namespace belvedere

#include "runtime/scene/entity_looks.h"

namespace belvedere {
namespace {

// Of what no rule fits, by domain: other, land, air, surface, subsurface.
const std::array<EntityLook, 5>& LooksOfDomains() {
  static const std::array<EntityLook, 5> kLooks = {{{-1, SymbolShape::kOther, {}},
                                                    {-1, SymbolShape::kGround, {}},
                                                    {-1, SymbolShape::kAir, {}},
                                                    {-1, SymbolShape::kSurface, {}},
                                                    {-1, SymbolShape::kSubsurface, {}}}};
  return kLooks;
}

}  // namespace

const EntityLook& EntityLooks::LookOf(const EntityType& type) const {
  for (const EntityRule& rule : rules_) {
    if (rule.pattern.Fits(type)) return rule.look;
  }
  const auto& looks = LooksOfDomains();
  return looks[type.domain < looks.size() ? type.domain : 0];
}

}  // namespace belvedere

#include "runtime/scene/entity_looks.h"

namespace belvedere {
namespace {

SymbolShape SymbolOfDomain(const EntityType& type) {
  switch (type.domain) {
    case 1: return SymbolShape::kGround;
    case 2: return SymbolShape::kAir;
    case 3: return SymbolShape::kSurface;
    case 4: return SymbolShape::kSubsurface;
    default: return SymbolShape::kOther;
  }
}

}  // namespace

EntityLook EntityLooks::LookOf(const EntityType& type) const {
  for (const EntityRule& rule : rules_) {
    if (rule.pattern.Fits(type)) return rule.look;
  }
  return {-1, SymbolOfDomain(type)};
}

}  // namespace belvedere

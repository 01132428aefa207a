#include "runtime/scene/entity_looks.h"

#include <charconv>

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

std::optional<EntityPattern> EntityPattern::Parse(std::string_view text) {
  EntityPattern pattern;
  for (size_t i = 0; !text.empty(); ++i) {
    if (i == kNumbers) return std::nullopt;
    const size_t dot = text.find('.');
    const std::string_view part = text.substr(0, dot);
    if (part != "*") {
      uint16_t number = 0;
      const auto parsed = std::from_chars(part.data(), part.data() + part.size(), number);
      if (parsed.ec != std::errc() || parsed.ptr != part.data() + part.size()) return std::nullopt;
      pattern.numbers_[i] = number;
    }
    if (dot == std::string_view::npos) break;
    text.remove_prefix(dot + 1);
    if (text.empty()) return std::nullopt;
  }
  return pattern;
}

bool EntityPattern::Fits(const EntityType& type) const {
  const std::array<uint16_t, kNumbers> own{type.kind,        type.domain,   type.country, type.category,
                                           type.subcategory, type.specific, type.extra};
  for (size_t i = 0; i < kNumbers; ++i) {
    if (numbers_[i] && *numbers_[i] != own[i]) return false;
  }
  return true;
}

EntityLook EntityLooks::LookOf(const EntityType& type) const {
  for (const EntityRule& rule : rules_) {
    if (rule.pattern.Fits(type)) return rule.look;
  }
  return {-1, SymbolOfDomain(type)};
}

}  // namespace belvedere

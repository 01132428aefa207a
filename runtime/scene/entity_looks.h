// EntityLooks: what an entity of some type looks like: which model of the catalogue, which symbol.
//
// Rules are tried in order; the first whose pattern fits wins. A pattern is up to seven numbers with dots between,
// each a number or *; what is left out fits anything: "1.2.*.57" is every fixed-wing airliner of every country. A type
// that no rule fits has no model and the symbol of its domain.
//
// Threads: read-only after it was made.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/object_table.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace belvedere {

class EntityPattern {
 public:
  // nullopt when it is not seven or fewer numbers and stars.
  static std::optional<EntityPattern> Parse(std::string_view text);
  bool Fits(const EntityType& type) const;

 private:
  static constexpr size_t kNumbers = 7;
  std::array<std::optional<uint16_t>, kNumbers> numbers_{};
};

struct EntityLook {
  int model = -1;  // number in the model catalogue; -1 none
  SymbolShape symbol = SymbolShape::kOther;
};

struct EntityRule {
  EntityPattern pattern;
  EntityLook look;
};

class EntityLooks {
 public:
  EntityLooks() = default;
  explicit EntityLooks(std::vector<EntityRule> rules) : rules_(std::move(rules)) {}
  EntityLook LookOf(const EntityType& type) const;

 private:
  std::vector<EntityRule> rules_;
};

}  // namespace belvedere

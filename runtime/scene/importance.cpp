#include "runtime/scene/importance.h"

#include <algorithm>
#include <utility>

namespace belvedere {
namespace {

constexpr std::array<std::string_view, kImportanceInputs> kNames = {
    "speed", "distance", "number", "damage", "friendly", "opposing", "neutral", "air", "land", "sea", "munition"};

}  // namespace

ImportanceInput ImportanceInputOf(std::string_view name) {
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  return static_cast<ImportanceInput>(found - kNames.begin());
}

std::string_view NameOf(ImportanceInput input) {
  return kNames[static_cast<size_t>(input)];
}

double FuzzyTerm::HeldBy(const ImportanceFacts& facts) const {
  const double x = facts[static_cast<size_t>(input)];
  if (x < full_from) return x <= from ? 0.0 : (x - from) / (full_from - from);
  if (x > full_to) return x >= to ? 0.0 : (to - x) / (to - full_to);
  return 1.0;
}

double ImportanceTable::Of(const ImportanceFacts& facts) const {
  double weights = 0, sum = 0;
  for (const ImportanceRule& rule : rules_) {
    double held = 1.0;
    for (const FuzzyTerm& term : rule.terms) held = std::min(held, term.HeldBy(facts));
    weights += held;
    sum += held * rule.value;
  }
  return weights > 0 ? std::clamp(sum / weights, 0.0, 1.0) : kUsualImportance;
}

}  // namespace belvedere

// Importance: how much a group of objects matters to whoever watches, from 0 to 1, by fuzzy rules over what its members
// are. Important groups are kept in finer detail than others (cluster_tree.h).
//
// A term is a trapezoid over a number: 0 up to `from`, rising to 1 at `full_from`, 1 up to `full_to`, falling to 0 at
// `to`. A rule holds as much as the least of its terms; the importance is the mean of the rules' values, weighted by
// how much each holds (Sugeno, 1985; zero order). Where no rule holds at all it is kUsualImportance.
//
// Units:   metres, metres a second.
// Threads: values; pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

namespace belvedere {

// What rules may ask about a group. All but speed, distance and number are shares of its members.
enum class ImportanceInput : uint8_t {
  kSpeed,     // mean, m/s
  kDistance,  // from the nearest watch area, m; 0 inside; far where there are none
  kNumber,    // of members
  kDamage,    // mean, 0 none to 1 destroyed
  kFriendly,
  kOpposing,
  kNeutral,
  kAir,
  kLand,
  kSea,
  kMunition,
  kCount,
};
inline constexpr size_t kImportanceInputs = static_cast<size_t>(ImportanceInput::kCount);
// "speed", "distance", ... ; kCount for other words.
ImportanceInput ImportanceInputOf(std::string_view name);
std::string_view NameOf(ImportanceInput input);
using ImportanceFacts = std::array<double, kImportanceInputs>;

struct FuzzyTerm {
  ImportanceInput input = ImportanceInput::kSpeed;
  double from = 0, full_from = 0, full_to = 0, to = 0;
  double HeldBy(const ImportanceFacts& facts) const;
};

struct ImportanceRule {
  std::vector<FuzzyTerm> terms;  // all of them
  double value = 0.5;
};

inline constexpr double kUsualImportance = 0.3;

class ImportanceTable {
 public:
  ImportanceTable() = default;
  explicit ImportanceTable(std::vector<ImportanceRule> rules) : rules_(std::move(rules)) {}
  double Of(const ImportanceFacts& facts) const;

 private:
  std::vector<ImportanceRule> rules_;
};

// A place that the user watches: what is near it matters more.
struct WatchArea {
  glm::dvec3 centre_ecef{0.0};
  double radius_m = 0;
};

}  // namespace belvedere

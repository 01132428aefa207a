#include "preproc/spec_reader.h"

#include <algorithm>
#include <numeric>

namespace belvedere {
namespace {

// Edit distance (Levenshtein).
size_t Distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view TomlTypeName(const toml::node& node) {
  if (node.is_string()) return "a string";
  if (node.is_integer() || node.is_floating_point()) return "a number";
  if (node.is_boolean()) return "true or false";
  if (node.is_array()) return "an array";
  return node.is_table() ? "a table" : "a date or time";
}

Status SpecReader::CheckKeys(const toml::table& table, const std::vector<std::string_view>& known) const {
  for (const auto& [key, value] : table) {
    const std::string_view name = key.str();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const auto nearest = std::min_element(known.begin(), known.end(), [&](std::string_view a, std::string_view b) {
      return Distance(name, a) < Distance(name, b);
    });
    return Status::Error("{}:{}: unknown key \"{}\"; the nearest known one is \"{}\"", file_, key.source().begin.line,
                         name, *nearest);
  }
  return {};
}

Result<std::string> SpecReader::String(const toml::table& table, std::string_view key) const {
  const toml::node* node = table.get(key);
  if (node == nullptr) return Error(table, "\"{}\" is missing", key);
  const auto value = node->value_exact<std::string>();
  if (!value) return Error(*node, "\"{}\" must be a string, here it is {}", key, TomlTypeName(*node));
  return *value;
}

Result<std::string> SpecReader::String(const toml::table& table, std::string_view key,
                                       const std::string& missing) const {
  if (!table.contains(key)) return missing;
  return String(table, key);
}

Result<double> SpecReader::Number(const toml::table& table, std::string_view key, double missing) const {
  const toml::node* node = table.get(key);
  if (node == nullptr) return missing;
  return Number(*node, key);
}

Result<double> SpecReader::Number(const toml::node& node, std::string_view key) const {
  if (!node.is_integer() && !node.is_floating_point()) {
    return Error(node, "\"{}\" must be a number, here it is {}", key, TomlTypeName(node));
  }
  return node.value<double>().value_or(0);
}

Result<std::vector<double>> SpecReader::Numbers(const toml::node& node, std::string_view key) const {
  std::vector<double> numbers;
  const toml::array* array = node.as_array();
  for (size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const auto number = Number((*array)[i], key);
    if (!number.ok()) return number.status();
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace belvedere

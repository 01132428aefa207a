#define TOML_EXCEPTIONS 0
#include "runtime/app/settings.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

namespace belvedere {

struct SettingsFile::State {
  std::string name;
  toml::table root;
  // First mistake by line.
  std::optional<std::pair<int, std::string>> mistake;

  void Record(int line, std::string message) {
    if (!mistake || line < mistake->first) mistake.emplace(line, std::move(message));
  }
};

struct SettingsTable::State {
  std::shared_ptr<SettingsFile::State> file;
  const toml::table* table = nullptr;
  std::string path;  // "window.view.", empty at the root
  std::vector<std::string> asked;

  const toml::node* Ask(std::string_view key) {
    if (std::find(asked.begin(), asked.end(), key) == asked.end()) asked.emplace_back(key);
    return table->get(key);
  }
  int LineOf(std::string_view key) const {
    const auto found = table->find(key);
    const toml::source_region region = found == table->end() ? table->source() : found->first.source();
    const toml::source_region fallback = found == table->end() ? table->source() : found->second.source();
    return static_cast<int>(region.begin.line != 0 ? region.begin.line : fallback.begin.line);
  }
  void Mistake(std::string_view key, std::string_view message) {
    constexpr int kAfterAllLines = 1 << 24;  // what is there and wrong is named before what is missing
    const int line = LineOf(key);
    file->Record(table->contains(key) ? line : kAfterAllLines + line,
                 fmt::format("{}:{}: {}{} {}", file->name, line, path, key, message));
  }
};

namespace {

std::string_view KindName(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "an array";
    case toml::node_type::string: return "a string";
    case toml::node_type::integer: return "an integer";
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "true or false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time: return "a date or time";
    case toml::node_type::none: break;
  }
  return "nothing";
}

std::string MustBe(std::string_view wanted, const toml::node& node) {
  return fmt::format("must be {}, but is {}", wanted, KindName(node));
}

size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string NearestWord(std::string_view word, const std::vector<std::string>& candidates) {
  std::string nearest;
  size_t least = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = EditDistance(word, candidate);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::optional<std::string> SettingsTable::String(std::string_view key) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) {
    state_->Mistake(key, MustBe("a string", *node));
    return std::nullopt;
  }
  return node->as_string()->get();
}

std::optional<double> SettingsTable::Number(std::string_view key, double least, double most) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_number()) {
    state_->Mistake(key, MustBe("a number", *node));
    return std::nullopt;
  }
  const double value = *node->value<double>();
  if (!(value >= least && value <= most)) {
    state_->Mistake(key, fmt::format("is {}, but must be {} to {}", value, least, most));
    return std::nullopt;
  }
  return value;
}

std::optional<int64_t> SettingsTable::Integer(std::string_view key, int64_t least, int64_t most) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_integer()) {
    state_->Mistake(key, MustBe("an integer", *node));
    return std::nullopt;
  }
  const int64_t value = node->as_integer()->get();
  if (value < least || value > most) {
    state_->Mistake(key, fmt::format("is {}, but must be {} to {}", value, least, most));
    return std::nullopt;
  }
  return value;
}

std::optional<bool> SettingsTable::Boolean(std::string_view key) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) {
    state_->Mistake(key, MustBe("true or false", *node));
    return std::nullopt;
  }
  return node->as_boolean()->get();
}

std::optional<std::vector<std::string>> SettingsTable::Strings(std::string_view key) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  const bool strings = array != nullptr && std::all_of(array->begin(), array->end(),
                                                       [](const toml::node& element) { return element.is_string(); });
  if (!strings) {
    state_->Mistake(key, array == nullptr ? MustBe("an array of strings", *node) : "must be an array of strings alone");
    return std::nullopt;
  }
  std::vector<std::string> values;
  for (const toml::node& element : *array) values.push_back(element.as_string()->get());
  return values;
}

std::optional<std::vector<double>> SettingsTable::Numbers(std::string_view key, size_t count) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  std::vector<double> values;
  if (array != nullptr) {
    for (const toml::node& element : *array) {
      const std::optional<double> value = element.value<double>();
      if (!value || !std::isfinite(*value)) break;
      values.push_back(*value);
    }
  }
  if (array == nullptr || array->size() != count || values.size() != count) {
    state_->Mistake(key, fmt::format("must be an array of {} numbers", count));
    return std::nullopt;
  }
  return values;
}

std::optional<std::vector<int64_t>> SettingsTable::Integers(std::string_view key, size_t count, int64_t least,
                                                            int64_t most) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  std::vector<int64_t> values;
  if (array != nullptr) {
    for (const toml::node& element : *array) {
      if (!element.is_integer()) break;
      values.push_back(element.as_integer()->get());
    }
  }
  const bool in_range =
      std::all_of(values.begin(), values.end(), [&](int64_t value) { return value >= least && value <= most; });
  if (array == nullptr || array->size() != count || values.size() != count || !in_range) {
    state_->Mistake(key, fmt::format("must be an array of {} integers from {} to {}", count, least, most));
    return std::nullopt;
  }
  return values;
}

std::optional<SettingsTable> SettingsTable::Table(std::string_view key) {
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) {
    state_->Mistake(key, MustBe("a table", *node));
    return std::nullopt;
  }
  auto state = std::make_shared<State>();
  state->file = state_->file;
  state->table = node->as_table();
  state->path = fmt::format("{}{}.", state_->path, key);
  return SettingsTable(std::move(state));
}

std::vector<SettingsTable> SettingsTable::Tables(std::string_view key) {
  std::vector<SettingsTable> tables;
  const toml::node* node = state_->Ask(key);
  if (node == nullptr) return tables;
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    state_->Mistake(key, fmt::format("must be written as [[{}{}]] tables", state_->path, key));
    return tables;
  }
  for (const toml::node& element : *array) {
    auto state = std::make_shared<State>();
    state->file = state_->file;
    state->table = element.as_table();
    state->path = fmt::format("{}{}.", state_->path, key);
    tables.push_back(SettingsTable(std::move(state)));
  }
  return tables;
}

std::vector<std::pair<std::string, std::string>> SettingsTable::AllStrings() {
  std::vector<std::pair<std::string, std::string>> strings;
  for (const auto& [key, node] : *state_->table) {
    if (const auto value = String(key.str())) strings.emplace_back(key.str(), *value);
  }
  return strings;
}

bool SettingsTable::Has(std::string_view key) const {
  return state_->table->contains(key);
}

void SettingsTable::Complain(std::string_view key, std::string_view message) {
  state_->Mistake(key, message);
}

void SettingsTable::CheckKeys() {
  for (const auto& [key, node] : *state_->table) {
    if (std::find(state_->asked.begin(), state_->asked.end(), key.str()) != state_->asked.end()) continue;
    const std::string nearest = NearestWord(key.str(), state_->asked);
    state_->Mistake(key.str(), nearest.empty()
                                   ? fmt::format("is not a known key; known are {}", fmt::join(state_->asked, ", "))
                                   : fmt::format("is not a known key; did you mean {}?", nearest));
  }
}

Result<SettingsFile> SettingsFile::Load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file) return Status::Error("{}: cannot be read; check the file name", path);
  return Parse(text.str(), path);
}

Result<SettingsFile> SettingsFile::Parse(std::string_view text, const std::string& name) {
  toml::parse_result parsed = toml::parse(text);
  if (!parsed) {
    return Status::Error("{}:{}: {}", name, parsed.error().source().begin.line, parsed.error().description());
  }
  auto state = std::make_shared<State>();
  state->name = name;
  state->root = std::move(parsed).table();
  return SettingsFile(std::move(state));
}

SettingsTable SettingsFile::root() const {
  auto state = std::make_shared<SettingsTable::State>();
  state->file = state_;
  state->table = &state_->root;
  return SettingsTable(std::move(state));
}

Status SettingsFile::status() const {
  return state_->mistake ? Status::Error("{}", state_->mistake->second) : Status();
}

}  // namespace belvedere

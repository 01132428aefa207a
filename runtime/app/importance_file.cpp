#include "runtime/app/importance_file.h"

#include "runtime/app/settings.h"

#include <algorithm>
#include <utility>

namespace belvedere {
namespace {

Result<ImportanceTable> Read(const SettingsFile& file) {
  SettingsTable root = file.root();
  std::vector<ImportanceRule> rules;
  for (SettingsTable& table : root.Tables("rule")) {
    ImportanceRule& rule = rules.emplace_back();
    const auto value = table.Number("value", 0, 1);
    if (!value && !table.Has("value")) table.Complain("value", "is missing: how much it matters, 0 to 1");
    rule.value = value.value_or(kUsualImportance);
    for (size_t i = 0; i < kImportanceInputs; ++i) {
      const auto input = static_cast<ImportanceInput>(i);
      const auto corners = table.Numbers(NameOf(input), 4);
      if (!corners) continue;
      if (!std::is_sorted(corners->begin(), corners->end()))
        table.Complain(NameOf(input), "must rise from number to number");
      rule.terms.push_back({input, (*corners)[0], (*corners)[1], (*corners)[2], (*corners)[3]});
    }
    table.CheckKeys();
  }
  root.CheckKeys();
  if (const Status status = file.status(); !status.ok()) return status;
  return ImportanceTable(std::move(rules));
}

}  // namespace

Result<ImportanceTable> LoadImportance(const std::string& path) {
  const Result<SettingsFile> file = SettingsFile::Load(path);
  if (!file.ok()) return file.status();
  return Read(*file);
}

Result<ImportanceTable> ParseImportance(std::string_view text, const std::string& name) {
  const Result<SettingsFile> file = SettingsFile::Parse(text, name);
  if (!file.ok()) return file.status();
  return Read(*file);
}

}  // namespace belvedere

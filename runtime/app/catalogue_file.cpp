#include "runtime/app/catalogue_file.h"

#include "runtime/app/settings.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

constexpr double kLongest_m = 1000;

SymbolShape ReadSymbol(SettingsTable& table) {
  static const std::map<std::string, SymbolShape> kShapes = {{"air", SymbolShape::kAir},
                                                             {"ground", SymbolShape::kGround},
                                                             {"surface", SymbolShape::kSurface},
                                                             {"subsurface", SymbolShape::kSubsurface},
                                                             {"other", SymbolShape::kOther}};
  const auto text = table.String("symbol");
  if (!text) return SymbolShape::kOther;
  const auto found = kShapes.find(*text);
  if (found != kShapes.end()) return found->second;
  table.Complain("symbol", fmt::format("is \"{}\", but must be air, ground, surface, subsurface or other", *text));
  return SymbolShape::kOther;
}

}  // namespace

Result<Catalogue> LoadCatalogue(const std::string& folder) {
  const Result<SettingsFile> file = SettingsFile::Load(folder + "/catalogue.toml");
  if (!file.ok()) return file.status();
  SettingsTable root = file->root();
  std::vector<ModelEntry> entries;
  std::vector<EntityRule> rules;
  for (SettingsTable& table : root.Tables("model")) {
    const auto name = table.String("name");
    if (!table.Has("name")) table.Complain("name", "is missing: the model's file without its ending");
    const auto length_m = table.Number("length_m", 0.01, kLongest_m);
    if (!table.Has("length_m")) table.Complain("length_m", "is missing: the real thing's length in metres");
    const EntityLook look{static_cast<int>(entries.size()), ReadSymbol(table), name.value_or("")};
    for (const std::string& text : table.Strings("entity_types").value_or(std::vector<std::string>{})) {
      const auto pattern = EntityPattern::Parse(text);
      if (!pattern)
        table.Complain("entity_types", fmt::format("has \"{}\", which is no pattern like \"1.2.*.57\"", text));
      if (pattern) rules.push_back({*pattern, look});
    }
    table.CheckKeys();
    entries.push_back({name.value_or(""), static_cast<float>(length_m.value_or(10))});
  }
  root.CheckKeys();
  if (const Status status = file->status(); !status.ok()) return status;
  return Catalogue{ModelCatalogue(folder, std::move(entries)), EntityLooks(std::move(rules))};
}

}  // namespace belvedere

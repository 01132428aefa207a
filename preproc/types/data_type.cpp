#include "preproc/types/data_type.h"

#include "preproc/hex_colour.h"
#include "preproc/spec_reader.h"
#include "preproc/types/process_modules.h"
#include "preproc/types/stock_types.h"
#include "runtime/paging/dataset_store.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace belvedere {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<MetaType, std::string_view>, 5> kMetaTypes = {
    {{MetaType::kHeightField, "height field"},
     {MetaType::kImage, "image"},
     {MetaType::kSurfaceProperty, "surface property"},
     {MetaType::kVector, "vector"},
     {MetaType::kModel, "model"}}};

// One [[type]] table.
class TypeParser : private SpecReader {
 public:
  TypeParser(const toml::table& table, const std::string& file) : SpecReader(file), table_(table) {}

  Result<DeclaredType> Parse() const {
    Status status = CheckKeys(table_, {"name", "parent", "meta", "read", "process", "write", "classes", "unit",
                                       "offset", "gain", "channels"});
    DeclaredType type;
    std::string meta;
    for (const auto& [key, text] : {std::pair<const char*, std::string*>{"name", &type.name},
                                    {"meta", &meta},
                                    {"read", &type.read},
                                    {"write", &type.write}}) {
      if (status.ok()) status = Take(String(table_, key), *text);
    }
    if (status.ok()) status = Take(String(table_, "parent", ""), type.parent);
    if (!status.ok()) return status;
    const auto known =
        std::find_if(kMetaTypes.begin(), kMetaTypes.end(), [&](const auto& one) { return one.second == meta; });
    if (known == kMetaTypes.end())
      return Error(
          table_,
          "type \"{}\": \"meta\" must be \"height field\", \"image\", \"surface property\", \"vector\" or \"model\"",
          type.name);
    type.meta = known->first;
    status = ParseProperty(type.property);
    if (status.ok()) status = ParseProcess(type);
    if (!status.ok()) return status;
    return type;
  }

 private:
  template <typename Value>
  static Status Take(Result<Value> read, Value& value) {
    if (read.ok()) value = std::move(*read);
    return read.status();
  }

  Status ParseProperty(PropertyRecord& property) const {
    double channels = 1;
    Status status = Take(String(table_, "unit", ""), property.unit);
    if (status.ok()) status = Take(Number(table_, "offset", 0), property.offset);
    if (status.ok()) status = Take(Number(table_, "gain", 1), property.gain);
    if (status.ok()) status = Take(Number(table_, "channels", 1), channels);
    if (!status.ok()) return status;
    if (!(channels >= 1 && channels <= kMostPropertyChannels) || channels != std::floor(channels))
      return Error(*table_.get("channels"), "\"channels\" must be 1 to {}", kMostPropertyChannels);
    property.channels = static_cast<int>(channels);
    const toml::node* classes = table_.get("classes");
    if (classes == nullptr) return {};
    const toml::array* list = classes->as_array();
    for (size_t i = 0; list != nullptr && i < list->size(); ++i) {
      const toml::table* one = (*list)[i].as_table();
      const auto name = one == nullptr ? std::nullopt : (*one)["name"].value<std::string>();
      const auto colour = one == nullptr ? std::nullopt : ParseHexColour((*one)["colour"].value_or(std::string()));
      if (!name || !colour || one->size() != 2)
        return Error((*list)[i], "a class has a \"name\" and a \"colour\" like \"#8fbf6f\" or \"#8fbf6f80\"");
      property.classes.push_back({*name, *colour});
    }
    if (property.classes.empty() || property.classes.size() > 256)
      return Error(*classes, "\"classes\" must be a list of 1 to 256");
    return {};
  }

  Status ParseProcess(DeclaredType& type) const {
    const toml::node* process = table_.get("process");
    if (process == nullptr) return {};
    const toml::array* list = process->as_array();
    if (list == nullptr) return Error(*process, "\"process\" must be a list of modules");
    for (const toml::node& node : *list) {
      auto use = ParseUse(node);
      if (!use.ok()) return use.status();
      type.process.push_back(std::move(*use));
    }
    return {};
  }

  Result<ModuleUse> ParseUse(const toml::node& node) const {
    ModuleUse use;
    if (const auto name = node.value<std::string>()) {
      use.module = *name;
      return use;
    }
    const toml::table* table = node.as_table();
    if (table == nullptr) return Error(node, "a module is its name, or {{ module = \"name\", .. }}");
    std::string run;
    Status status = Take(String(*table, "module"), use.module);
    if (status.ok()) status = Take(String(*table, "run", "parallel"), run);
    if (!status.ok()) return status;
    if (run != "parallel" && run != "series") return Error(node, "\"run\" must be \"parallel\" or \"series\"");
    use.in_series = run == "series";
    for (const auto& [key, value] : *table) {
      if (key == "module" || key == "run") continue;
      std::vector<double>& numbers = use.settings[std::string(key.str())];
      if (value.is_array()) {
        status = Take(Numbers(value, key.str()), numbers);
      } else {
        status = Take(Number(value, key.str()), numbers.emplace_back());
      }
      if (!status.ok()) return status;
    }
    return use;
  }

  const toml::table& table_;
};

}  // namespace

std::string_view MetaTypeName(MetaType meta) {
  return std::find_if(kMetaTypes.begin(), kMetaTypes.end(), [&](const auto& one) { return one.first == meta; })->second;
}

LayerKind KindOf(MetaType meta) {
  switch (meta) {
    case MetaType::kHeightField: return LayerKind::kElevation;
    case MetaType::kImage: return LayerKind::kImagery;
    case MetaType::kSurfaceProperty: return LayerKind::kProperty;
    case MetaType::kVector: return LayerKind::kVector;
    case MetaType::kModel: break;
  }
  return LayerKind::kModel;
}

const DeclaredTypes& DeclaredTypes::Stock() {
  static const DeclaredTypes stock = [] {
    DeclaredTypes types;
    const Status status =
        types.Add(toml::parse(std::string_view(kStockTypes), std::string_view("stock types")), "stock types");
    BELVEDERE_CHECK(status.ok());
    return types;
  }();
  return stock;
}

Status DeclaredTypes::Add(const toml::table& root, const std::string& file) {
  const toml::node* node = root.get("type");
  if (node == nullptr) return {};
  const toml::array* tables = node->as_array();
  for (size_t i = 0; tables != nullptr && i < tables->size(); ++i) {
    const toml::table* table = (*tables)[i].as_table();
    if (table == nullptr) break;
    auto type = TypeParser(*table, file).Parse();
    if (!type.ok()) return type.status();
    const auto error = [&](const std::string& reason) {
      return Status::Error("{}:{}: type \"{}\": {}", file, table->source().begin.line, type->name, reason);
    };
    if (Find(type->name) != nullptr) return error("a type of that name is there already");
    const DeclaredType* parent = type->parent.empty() ? nullptr : Find(type->parent);
    if (!type->parent.empty() && parent == nullptr)
      return error(fmt::format("there is no type \"{}\" before it to be its parent", type->parent));
    Status fits = CheckModules(*type);
    if (fits.ok() && parent != nullptr) fits = CheckParent(*type, *parent);
    if (!fits.ok()) return error(fits.message());
    types_.push_back(std::move(*type));
  }
  if (tables != nullptr && tables->is_array_of_tables()) return {};
  return Status::Error("{}:{}: \"type\" must be tables: write [[type]]", file, node->source().begin.line);
}

const DeclaredType* DeclaredTypes::Find(std::string_view name) const {
  const auto found =
      std::find_if(types_.begin(), types_.end(), [&](const DeclaredType& type) { return type.name == name; });
  return found == types_.end() ? nullptr : &*found;
}

std::string TypeToJson(const DeclaredType& type) {
  json process = json::array();
  for (const ModuleUse& use : type.process)
    process.push_back({{"module", use.module}, {"in_series", use.in_series}, {"settings", use.settings}});
  return json{{"name", type.name},
              {"parent", type.parent},
              {"meta", MetaTypeName(type.meta)},
              {"read", type.read},
              {"write", type.write},
              {"process", process},
              {"property", json::parse(store::PropertyToJson(type.property))}}
      .dump();
}

Result<DeclaredType> TypeFromJson(std::string_view text) {
  try {
    const json in = json::parse(text);
    DeclaredType type;
    type.name = in.at("name").get<std::string>();
    type.parent = in.at("parent").get<std::string>();
    const auto meta = in.at("meta").get<std::string>();
    for (const auto& [known, name] : kMetaTypes) {
      if (name == meta) type.meta = known;
    }
    type.read = in.at("read").get<std::string>();
    type.write = in.at("write").get<std::string>();
    for (const json& use : in.at("process"))
      type.process.push_back({use.at("module").get<std::string>(), use.at("in_series").get<bool>(),
                              use.at("settings").get<ModuleSettings>()});
    type.property = store::PropertyFromJson(in.at("property").dump());
    if (Status status = CheckModules(type); !status.ok())
      return Status::Error("data type \"{}\", which this builder cannot make: {}", type.name, status.message());
    return type;
  } catch (const std::exception& problem) {
    return Status::Error("a data type is damaged ({})", problem.what());
  }
}

}  // namespace belvedere

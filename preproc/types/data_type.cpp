#include "preproc/types/data_type.h"

#include "preproc/types/process_modules.h"
#include "preproc/types/stock_types.h"

#include <toml++/toml.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace belvedere {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<MetaType, std::string_view>, 3> kMetaTypes = {
    {{MetaType::kHeightField, "height field"},
     {MetaType::kImage, "image"},
     {MetaType::kSurfaceProperty, "surface property"}}};

// One [[type]] table.
class TypeParser {
 public:
  TypeParser(const toml::table& table, const std::string& file) : table_(table), file_(file) {}

  Result<DeclaredType> Parse() {
    static constexpr std::array<std::string_view, 11> kKeys = {
        "name", "parent", "meta", "read", "process", "write", "classes", "unit", "offset", "gain", "channels"};
    for (const auto& [key, value] : table_) {
      if (std::find(kKeys.begin(), kKeys.end(), key.str()) == kKeys.end())
        return Error(value, "a type has no key \"{}\"", std::string_view(key.str()));
    }
    DeclaredType type;
    for (const auto& [key, text] :
         {std::pair<const char*, std::string*>{"name", &type.name}, {"read", &type.read}, {"write", &type.write}}) {
      *text = table_[key].value_or(std::string());
      if (text->empty()) return Error(table_, "a type needs a \"{}\", some text", key);
    }
    type.parent = table_["parent"].value_or(std::string());
    const std::string meta = table_["meta"].value_or(std::string());
    const auto known =
        std::find_if(kMetaTypes.begin(), kMetaTypes.end(), [&](const auto& one) { return one.second == meta; });
    if (known == kMetaTypes.end())
      return Error(table_, "type \"{}\": \"meta\" must be \"height field\", \"image\" or \"surface property\"",
                   type.name);
    type.meta = known->first;
    if (Status status = ParseProperty(type); !status.ok()) return status;
    if (Status status = ParseProcess(type); !status.ok()) return status;
    return type;
  }

 private:
  template <typename... Args>
  Status Error(const toml::node& node, fmt::format_string<Args...> format, Args&&... args) const {
    return Status::Error("{}:{}: {}", file_, node.source().begin.line,
                         fmt::format(format, std::forward<Args>(args)...));
  }

  // "#rrggbb" or "#rrggbbaa".
  static std::optional<std::array<uint8_t, 4>> Colour(std::string_view text) {
    if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return std::nullopt;
    std::array<uint8_t, 4> colour{0, 0, 0, 255};
    for (size_t i = 0; i < (text.size() - 1) / 2; ++i) {
      const char* const first = text.data() + 1 + 2 * i;
      const auto [end, problem] = std::from_chars(first, first + 2, colour[i], 16);
      if (problem != std::errc() || end != first + 2) return std::nullopt;
    }
    return colour;
  }

  Status ParseProperty(DeclaredType& type) const {
    PropertyRecord& property = type.property;
    property.unit = table_["unit"].value_or(std::string());
    property.offset = table_["offset"].value_or(0.0);
    property.gain = table_["gain"].value_or(1.0);
    property.channels = table_["channels"].value_or(1);
    if (property.channels < 1 || property.channels > 4)
      return Error(table_, "type \"{}\": \"channels\" must be 1 to 4", type.name);
    const toml::node* classes = table_.get("classes");
    if (classes == nullptr) return {};
    const toml::array* list = classes->as_array();
    for (size_t i = 0; list != nullptr && i < list->size(); ++i) {
      const toml::table* one = (*list)[i].as_table();
      const auto name = one == nullptr ? std::nullopt : (*one)["name"].value<std::string>();
      const auto colour = one == nullptr ? std::nullopt : Colour((*one)["colour"].value_or(std::string()));
      if (!name || !colour || one->size() != 2)
        return Error((*list)[i], "a class has a \"name\" and a \"colour\" like \"#8fbf6f\" or \"#8fbf6f80\"");
      property.classes.push_back({*name, *colour});
    }
    if (property.classes.empty() || property.classes.size() > 256)
      return Error(*classes, "type \"{}\": \"classes\" must be a list of 1 to 256", type.name);
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
    if (table == nullptr || !(*table)["module"].is_string())
      return Error(node, "a module is its name, or {{ module = \"name\", .. }}");
    use.module = (*table)["module"].value_or(std::string());
    const std::string run = (*table)["run"].value_or(std::string("parallel"));
    if (run != "parallel" && run != "series") return Error(node, "\"run\" must be \"parallel\" or \"series\"");
    use.in_series = run == "series";
    for (const auto& [key, value] : *table) {
      if (key == "module" || key == "run") continue;
      std::vector<double>& numbers = use.settings[std::string(key.str())];
      if (const toml::array* list = value.as_array()) {
        for (const toml::node& number : *list) numbers.push_back(number.value_or(std::nan("")));
      } else {
        numbers.push_back(value.value_or(std::nan("")));
      }
      if (std::any_of(numbers.begin(), numbers.end(), [](double number) { return !std::isfinite(number); }))
        return Error(value, "\"{}\" of module \"{}\" must be a number or a list of numbers",
                     std::string_view(key.str()), use.module);
    }
    return use;
  }

  const toml::table& table_;
  const std::string& file_;
};

}  // namespace

std::string_view MetaTypeName(MetaType meta) {
  return std::find_if(kMetaTypes.begin(), kMetaTypes.end(), [&](const auto& one) { return one.first == meta; })->second;
}

LayerKind KindOf(MetaType meta) {
  return meta == MetaType::kHeightField ? LayerKind::kElevation
         : meta == MetaType::kImage     ? LayerKind::kImagery
                                        : LayerKind::kProperty;
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
    if (Status status = CheckModules(*type, parent); !status.ok()) return error(status.message());
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
  json process = json::array(), classes = json::array();
  for (const ModuleUse& use : type.process)
    process.push_back({{"module", use.module}, {"in_series", use.in_series}, {"settings", use.settings}});
  for (const PropertyClass& one : type.property.classes)
    classes.push_back({{"name", one.name}, {"colour", one.colour}});
  return json{{"name", type.name},
              {"parent", type.parent},
              {"meta", MetaTypeName(type.meta)},
              {"read", type.read},
              {"write", type.write},
              {"process", process},
              {"classes", classes},
              {"channels", type.property.channels},
              {"offset", type.property.offset},
              {"gain", type.property.gain},
              {"unit", type.property.unit}}
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
    for (const json& one : in.at("classes"))
      type.property.classes.push_back(
          {one.at("name").get<std::string>(), one.at("colour").get<std::array<uint8_t, 4>>()});
    type.property.channels = in.at("channels").get<int>();
    type.property.offset = in.at("offset").get<double>();
    type.property.gain = in.at("gain").get<double>();
    type.property.unit = in.at("unit").get<std::string>();
    for (const ModuleUse& use : type.process) {
      if (ProcessModules::Stock().Find(use.module) == nullptr)
        return Status::Error("data type \"{}\" needs the module \"{}\", which this builder has not", type.name,
                             use.module);
    }
    return type;
  } catch (const std::exception& problem) {
    return Status::Error("a data type is damaged ({})", problem.what());
  }
}

}  // namespace belvedere

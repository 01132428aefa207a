// Data types: what a layer of a dataset may be, declared in TOML, those that every spec has and those that it adds.
//
// A type names its parent, whose pages it is made of, and the modules that read those pages, process them one after the
// other, and write what comes out. What is written is of a meta-type, which the run time knows: that is all it has to
// know of the type. Types without a parent are made of sources.
//
//   [[type]]
//   name = "slope classes"
//   parent = "elevation"
//   meta = "surface property"         # or "height field", "image", "vector", "model"
//   read = "height pages"
//   process = ["slope", { module = "classes", limits = [5, 15, 30], run = "series" }]
//   write = "property pages"
//   classes = [{ name = "flat", colour = "#8fbf6f" }, ...]      # what the bytes mean: classes,
//   unit = "deg", offset = 0, gain = 0.5, channels = 1          # or numbers
//
// What the bytes mean follows from the modules, and what a type says of them must be that: a mistake shows at once, not
// in the pages.
//
// A module runs for many pages at once ("parallel"), unless it says `run = "series"`: then for one at a time.
//
// Threads: values; pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toml {
inline namespace v3 {
class table;
}
}  // namespace toml

namespace belvedere {

enum class MetaType { kHeightField, kImage, kSurfaceProperty, kVector, kModel };
std::string_view MetaTypeName(MetaType meta);  // "height field", ..

// Numbers by their keys; one alone is a list of one.
using ModuleSettings = std::map<std::string, std::vector<double>>;

struct ModuleUse {
  std::string module;
  bool in_series = false;
  ModuleSettings settings;
};

// A data type; the run time's DataType is the number of a layer.
struct DeclaredType {
  std::string name;
  std::string parent;  // empty: made of sources
  MetaType meta = MetaType::kSurfaceProperty;
  std::string read, write;
  std::vector<ModuleUse> process;
  PropertyRecord property;  // of a surface property
};

// What the spec calls it, as a layer's kind in the dataset.
LayerKind KindOf(MetaType meta);

class DeclaredTypes {
 public:
  // Those of stock_types.h.
  static const DeclaredTypes& Stock();

  // Adds the types of the TOML's [[type]] tables, in their order. file names it in messages. Fails where a name is
  // taken, a parent or a module is not known, or modules do not fit each other (process_modules.h).
  Status Add(const toml::table& root, const std::string& file);
  const DeclaredType* Find(std::string_view name) const;

 private:
  std::vector<DeclaredType> types_;
};

// One line of JSON, and back: what a dataset keeps of a type. The reason alone where the text is bad.
std::string TypeToJson(const DeclaredType& type);
Result<DeclaredType> TypeFromJson(std::string_view text);

}  // namespace belvedere

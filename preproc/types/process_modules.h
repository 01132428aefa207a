// Process modules: what the network of a data type is made of. One module is a name and a function.
//
// A module takes one page and makes another of it: the function gets what flows, a quadnode and the page so far, and
// changes it. Adding one means writing that function and registering it:
//
//   Status Halve(const ModuleSettings&, const ModuleContext&, PageFlow& flow) {
//     for (uint8_t& value : flow.property->values) value /= 2;
//     return {};
//   }
//   ProcessModules::Stock().Add({"halve", MetaType::kSurfaceProperty, MetaType::kSurfaceProperty, {}, {}, Halve});
//
// and a type that names "halve" in its `process` uses it. A function sees one page alone, whose apron holds the posts
// of the neighbours: what it makes of a post must depend on those around it and on nothing else, so that neighbours
// agree along their border.
//
// Threads: registration at start, by one thread. Functions run on many threads at once, those that are used in series
// on one at a time.
#pragma once

#include "preproc/types/data_type.h"
#include "runtime/base/status.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/building_page.h"
#include "runtime/paging/page.h"
#include "runtime/paging/vector_page.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

// One of the pages is there: that of the meta-type that the last module gave.
struct PageFlow {
  Quadcode node;
  std::shared_ptr<ElevationPage> heights;
  std::shared_ptr<ImagePage> image;  // its level 0
  std::shared_ptr<PropertyPage> property;
  std::shared_ptr<VectorPage> features;
  std::shared_ptr<BuildingPage> buildings;
};

struct ModuleContext {
  const Geoid& sea;
  // What the bytes of the property that it takes mean: numbers. Of other pages, nothing.
  PropertyRecord takes{};
};

struct ProcessModule {
  std::string name;
  MetaType takes = MetaType::kHeightField, gives = MetaType::kSurfaceProperty;
  std::vector<std::string> settings;  // the keys that it must be given
  // What the bytes of the property that it gives mean, of what those mean that it takes; its classes are the type's to
  // name. Where there is none they mean the same.
  std::function<PropertyRecord(const PropertyRecord& takes)> meaning;
  std::function<Status(const ModuleSettings&, const ModuleContext&, PageFlow&)> process;
};

class ProcessModules {
 public:
  // "slope", "normals", "roughness", "water": of heights (surface_properties.h). "classes": of a property's first
  // channel, how many of the `limits`, in its own unit, its value reaches. "raise": models of the buildings among
  // features (vectors/buildings.h).
  static ProcessModules& Stock();

  Status Add(ProcessModule module);  // fails where the name is taken
  const ProcessModule* Find(std::string_view name) const;
  std::string names() const;  // for messages

 private:
  std::vector<ProcessModule> modules_;
};

// "height pages", "image pages", "property pages", "vector pages", "model pages": what reads and writes pages of a
// meta-type. Nothing of another name.
std::optional<MetaType> PagesOf(std::string_view reader_or_writer);

// What the bytes mean after each module of the type, where `parent` is what they mean before the first.
std::vector<PropertyRecord> MeaningsAlong(const DeclaredType& type, const PropertyRecord& parent);

// Why the modules of a type do not fit each other; ok where they do.
Status CheckModules(const DeclaredType& type);
// And why they do not fit its parent, or what it says of its bytes. REQUIRES: CheckModules is ok.
Status CheckParent(const DeclaredType& type, const DeclaredType& parent);

}  // namespace belvedere

// Read modules: what the servers know how to read or to make. One module makes the pages of one layer.
//
// A module is a name, a kind of page, a rule for which quadnodes have a page, and one function. Adding a layer means
// writing that function and registering it; no server changes. A layer that tints the ground by its slope would be:
//
//   Result<std::unique_ptr<Page>> ReadSlopeTint(ReadContext& context, DataType elevation, Quadcode node) {
//     Result<PagePin> heights = context.Obtain(elevation, node);   // from the cache if it is there
//     if (!heights.ok()) return heights.status();
//     return TintBySlope(heights->as<ElevationPage>(), node);      // pure; returns an ImagePage
//   }
//
//   const ReadModule* elevation = registry.Find("elevation");
//   registry.Add({.layer = "slope",
//                 .kind = PageKind::kOverlay,
//                 .max_level = elevation->max_level,
//                 .role = LayerRole::kMultiply,
//                 .exists = elevation->exists,
//                 .read = [type = elevation->type](ReadContext& context, Quadcode node) {
//                   return ReadSlopeTint(context, type, node);
//                 }});
//
// and a view that names "slope" among its layers shows it. A module may obtain pages of the layers that were registered
// before it, so that no two can wait for each other.
//
// Threads: registration at start, by one thread; afterwards read by any. `read` runs on the threads of its server and
// of those whose modules obtain its pages: it keeps no state of its own that is not safe for that.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/layer_table.h"
#include "runtime/paging/paging.h"

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace belvedere {

class ModuleRegistry;

// What a module may use while it makes one page.
class ReadContext {
 public:
  // reader: the layer whose page is being made.
  ReadContext(Paging& paging, const ModuleRegistry& registry, DataType reader)
      : paging_(paging), registry_(registry), reader_(reader) {}

  // The page of another layer, pinned: the one in the cache, or else read right here and inserted. A failure is marked
  // in the cache. REQUIRES: type was registered before the reader's.
  Result<PagePin> Obtain(DataType type, Quadcode node);

 private:
  Paging& paging_;
  const ModuleRegistry& registry_;
  const DataType reader_;
};

struct ReadModule {
  std::string layer;  // its name in the layer table
  PageKind kind = PageKind::kElevation;
  int max_level = 0;
  LayerRole role = LayerRole::kColour;  // of an image layer
  bool is_made = false;                 // Layer::is_made
  std::optional<StepOf> step;           // of a layer that changes with the time; that of the layer's name comes first
  // Whether there is a page; the children of a quadnode exist together or not at all.
  std::function<bool(Quadcode)> exists;
  std::function<Result<std::unique_ptr<Page>>(ReadContext&, Quadcode)> read;
  int threads = 1;    // that its server should have
  DataType type = 0;  // given by the registry
};

class ModuleRegistry {
 public:
  // Gives the module the next data type. Fails when the name is taken.
  Status Add(ReadModule module);
  const ReadModule* Find(std::string_view layer) const;
  const ReadModule& at(DataType type) const { return modules_[type]; }
  const std::deque<ReadModule>& modules() const { return modules_; }

 private:
  std::deque<ReadModule> modules_;  // what was returned stays where it is
};

// The layers of all modules; each has the data type of its module.
LayerTable MakeLayerTable(const ModuleRegistry& registry);

// Reads or makes one page and puts it nowhere; what it is made of goes into the paging's cache. REQUIRES: it exists.
Result<std::unique_ptr<Page>> ReadPage(Paging& paging, const ModuleRegistry& registry, const PageKey& key);

// Reads one page, inserts it into the cache and returns it pinned; or marks it failed and says why. A page that is
// there already, or that failed already, is not read again. Exceptions of the module become failures.
Result<PagePin> ReadIntoCache(Paging& paging, const ModuleRegistry& registry, const PageKey& key);

}  // namespace belvedere

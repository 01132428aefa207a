#include "servers/read_module.h"

#include "runtime/base/trace.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace belvedere {
namespace {

const char* SpanName(PageKind kind) {
  switch (kind) {
    case PageKind::kElevation: return "servers.elevation";
    case PageKind::kTerrain: return "servers.terrain";
    case PageKind::kColour: return "servers.colour";
    case PageKind::kOverlay: return "servers.overlay";
    case PageKind::kModel: return "servers.model";
  }
  return "servers.page";
}

// Calls the module; whatever it throws becomes a Status.
Result<std::unique_ptr<Page>> Read(const ReadModule& module, ReadContext& context, Quadcode node) {
  const TraceSpan span(SpanName(module.kind));
  try {
    return module.read(context, node);
  } catch (const std::exception& problem) {
    return Status::Error("layer {}, page {}: {}", module.layer, node.ToString(), problem.what());
  } catch (...) {
    return Status::Error("layer {}, page {}: its read module failed for an unknown reason", module.layer,
                         node.ToString());
  }
}

}  // namespace

Result<PagePin> ReadContext::Obtain(DataType type, Quadcode node) {
  BELVEDERE_CHECK(type < reader_);
  return ReadIntoCache(paging_, registry_, {type, node});
}

Status ModuleRegistry::Add(ReadModule module) {
  BELVEDERE_CHECK(module.exists && module.read && module.threads > 0);
  if (Find(module.layer) != nullptr) {
    return Status::Error("layer {}: the name is taken by another layer; give it another name where it is built",
                         module.layer);
  }
  module.type = static_cast<DataType>(modules_.size());
  modules_.push_back(std::move(module));
  return {};
}

const ReadModule* ModuleRegistry::Find(std::string_view layer) const {
  const auto found =
      std::find_if(modules_.begin(), modules_.end(), [&](const ReadModule& module) { return module.layer == layer; });
  return found == modules_.end() ? nullptr : &*found;
}

LayerTable MakeLayerTable(const ModuleRegistry& registry) {
  LayerTable table;
  for (const ReadModule& module : registry.modules()) {
    const DataType type = table.Add(
        {module.layer, module.kind, 0, module.max_level, module.exists, module.role, module.step, {}, module.is_made});
    BELVEDERE_CHECK(type == module.type);
  }
  return table;
}

Result<std::unique_ptr<Page>> ReadPage(Paging& paging, const ModuleRegistry& registry, const PageKey& key) {
  ReadContext context(paging, registry, key.type);
  return Read(registry.at(key.type), context, key.node);
}

Result<PagePin> ReadIntoCache(Paging& paging, const ModuleRegistry& registry, const PageKey& key) {
  if (paging.cache.Contains(key)) {  // asked first, so that only the managers' misses are counted
    if (PagePin pin = paging.cache.Find(key)) return pin;
  }
  if (Status failure = paging.cache.FailureOf(key); !failure.ok()) return failure;
  const ReadModule& module = registry.at(key.type);
  if (!module.exists(key.node)) {
    return Status::Error("layer {}: there is no page {}", module.layer, key.node.ToString());
  }
  Result<std::unique_ptr<Page>> page = ReadPage(paging, registry, key);
  if (!page.ok()) {
    paging.cache.MarkFailed(key, page.status());
    return page.status();
  }
  return paging.cache.Insert(key, std::move(*page));
}

}  // namespace belvedere

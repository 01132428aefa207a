#include "runtime/paging/layer_table.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <utility>

namespace belvedere {

DataType LayerTable::Add(Layer layer) {
  BELVEDERE_CHECK(Find(layer.name) == nullptr);
  layer.type = static_cast<DataType>(layers_.size());
  layers_.push_back(std::move(layer));
  return layers_.back().type;
}

const Layer* LayerTable::Find(std::string_view name) const {
  const auto found =
      std::find_if(layers_.begin(), layers_.end(), [&](const Layer& layer) { return layer.name == name; });
  return found == layers_.end() ? nullptr : &*found;
}

const Layer* LayerTable::FirstOf(PageKind kind) const {
  const auto found =
      std::find_if(layers_.begin(), layers_.end(), [&](const Layer& layer) { return layer.kind == kind; });
  return found == layers_.end() ? nullptr : &*found;
}

std::optional<Quadcode> LayerTable::DeepestExisting(DataType type, Quadcode node) const {
  const Layer& layer = at(type);
  if (node.level() > layer.max_level) node = node.Ancestor(layer.max_level);
  while (!layer.exists(node)) {
    if (node.is_root()) return std::nullopt;
    node = node.Parent();
  }
  return node;
}

}  // namespace belvedere

#include "runtime/paging/layer_table.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <utility>

namespace belvedere {

DataType LayerTable::Add(Layer layer) {
  BELVEDERE_CHECK(Find(layer.name) == nullptr);
  const auto type = static_cast<DataType>(layers_.size());
  layer.type = type;
  layer.steps.clear();
  layers_.push_back(std::move(layer));
  if (layers_.back().step) AddStep(*layers_.back().step, type);
  return type;
}

void LayerTable::AddStep(const StepOf& step, DataType type) {
  const Layer* whole = Find(step.layer);
  BELVEDERE_CHECK(whole != nullptr && whole->step);
  std::vector<LayerStep>& steps = layers_[whole->type].steps;
  const auto later = std::find_if(steps.begin(), steps.end(), [&](const LayerStep& other) {
    return IsEarlier(step.utc_s, other.utc_s, whole->step->repeats);
  });
  steps.insert(later, {step.utc_s, type});
}

DataType LayerTable::TypeAt(DataType type, double utc_s) const {
  const Layer& layer = at(type);
  if (layer.steps.empty()) return type;
  return layer.steps[StepAt(layer.steps, layer.step->repeats, utc_s)].type;
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

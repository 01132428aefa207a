#include "preproc/dataset_spec.h"

#include "preproc/open_layer.h"
#include "preproc/source_settings.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace belvedere {
namespace {

const std::string& WholeName(const LayerSpec& layer) {
  return layer.step ? layer.step->layer : layer.name;
}

Status AddSource(LayerSpec& layer, const SourceSpec& source) {
  const std::string settings = SettingsToJson(source);
  for (const SourceSpec& other : layer.sources) {
    if (SettingsToJson(other) != settings) continue;
    return Status::Error("{}: it is in layer {} already; belvedere-build update makes anew what has changed",
                         source.written_path, layer.name);
  }
  const auto at = source.utc_s || !layer.step
                      ? layer.sources.end()
                      : std::find_if(layer.sources.begin(), layer.sources.end(),
                                     [](const SourceSpec& other) { return other.utc_s.has_value(); });
  layer.sources.insert(at, source);
  return {};
}

// A layer, or a step, of what is added.
Status AddLayer(BuildSpec& spec, const LayerSpec& added, size_t layers_before) {
  bool known = false;
  for (size_t i = 0; i < layers_before; ++i) {
    LayerSpec& layer = spec.layers[i];
    if (WholeName(layer) != WholeName(added)) continue;
    if (layer.kind != added.kind) return Status::Error("layer {} is of another kind", layer.name);
    if (layer.derived || added.derived)
      return Status::Error("layer {} is there already, made of layer {}", layer.name,
                           (layer.derived ? layer : added).derived->of);
    if (added.priority == Priority::kResolution && layer.priority != added.priority)
      return Status::Error("layer {}: its sources are in the order of its spec; build the dataset again", layer.name);
    const bool same_step = layer.step && added.step && layer.step->utc_s == added.step->utc_s;
    if (added.step && (!same_step || layer.step->repeats != added.step->repeats)) continue;
    known = true;
    for (const SourceSpec& source : added.sources) {
      if (Status status = AddSource(layer, source); !status.ok()) return status;
    }
  }
  if (known) return {};
  if (added.derived) {
    const bool has_parent = std::any_of(spec.layers.begin(), spec.layers.end(),
                                        [&](const LayerSpec& layer) { return IsMadeOf(added, layer); });
    if (!has_parent)
      return Status::Error("layer {}: there is no layer {} of type \"{}\" that it could be made of", added.name,
                           added.derived->of, added.derived->type.parent);
  }
  const bool has_other_steps =
      std::any_of(spec.layers.begin(), spec.layers.begin() + static_cast<ptrdiff_t>(layers_before),
                  [&](const LayerSpec& layer) { return WholeName(layer) == WholeName(added); });
  if (has_other_steps) {
    return Status::Error(
        "layer {}: it has no step like {}, and none can come between its layers; build the dataset again",
        WholeName(added), added.name);
  }
  spec.layers.push_back(added);
  return {};
}

}  // namespace

Result<BuildSpec> SpecOf(const Dataset& dataset) {
  BuildSpec spec;
  spec.path = dataset.path();
  for (const LayerRecord& record : dataset.layers()) {
    if (record.rules != kBuilderRules) {
      return Status::Error(
          "{}: layer {} was built by another builder, whose pages do not fit those of this one; build it "
          "again",
          dataset.path(), record.name);
    }
    LayerSpec layer{
        record.name, record.kind, {}, record.step, record.finest_last ? Priority::kResolution : Priority::kOrder, {}};
    if (record.derivation) {
      auto type = TypeFromJson(record.derivation->definition);
      if (!type.ok()) return Status::Error("{}: layer {}: {}", dataset.path(), record.name, type.message());
      layer.derived = {std::move(*type), record.derivation->of};
    }
    for (const SourceRecord& source : record.sources) {
      auto settings = SettingsFromJson(source.settings);
      if (!settings.ok()) return Status::Error("{}: source {}: {}", dataset.path(), source.path, settings.message());
      layer.sources.push_back(std::move(*settings));
    }
    spec.layers.push_back(std::move(layer));
  }
  return spec;
}

Result<BuildSpec> WithAdded(BuildSpec spec, const BuildSpec& added) {
  const size_t layers_before = spec.layers.size();
  for (const LayerSpec& layer : added.layers) {
    if (Status status = AddLayer(spec, layer, layers_before); !status.ok()) return status;
  }
  if (spec.layers.size() > static_cast<size_t>(kMaxDatasetLayers))
    return Status::Error("{}: {} layers, at most {} fit a dataset", spec.path, spec.layers.size(), kMaxDatasetLayers);
  return spec;
}

Result<BuildSpec> WithRemoved(BuildSpec spec, const std::string& source, const std::string& layer) {
  std::error_code error;
  const std::string opened = std::filesystem::weakly_canonical(source, error).string();
  bool found = false;
  for (LayerSpec& from : spec.layers) {
    if (!layer.empty() && layer != from.name && layer != WholeName(from)) continue;
    found |= std::erase_if(from.sources, [&](const SourceSpec& other) {
               return other.written_path == source || other.path == source || other.path == opened;
             }) > 0;
    if (from.derived) continue;
    const bool has_own = std::any_of(from.sources.begin(), from.sources.end(),
                                     [&](const SourceSpec& other) { return !from.step || other.utc_s; });
    if (!has_own) {
      return Status::Error("{}: layer {} would be left without a source; build the dataset again without that layer",
                           spec.path, from.name);
    }
  }
  if (found) return spec;
  return Status::Error("{}: {} is no source of {}; belvedere-build info lists them", spec.path, source,
                       layer.empty() ? "it" : "its layer " + layer);
}

}  // namespace belvedere

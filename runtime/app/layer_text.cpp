#include "runtime/app/layer_text.h"

#include "runtime/app/settings.h"
#include "runtime/scene/display_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace belvedere {
namespace {

constexpr std::array<std::pair<std::string_view, LayerRole>, 5> kRoles{{{"colour", LayerRole::kColour},
                                                                        {"grey", LayerRole::kGrey},
                                                                        {"multiply", LayerRole::kMultiply},
                                                                        {"night", LayerRole::kNight},
                                                                        {"water", LayerRole::kWater}}};
constexpr std::string_view kUsage =
    "settings are off, on, opacity=0..1, gamma=0.1..10, multiplier=0..100, role=colour|grey|multiply|night|water";

// That a view may name; of a layer's steps only the one that stands for all.
bool IsImage(const Layer& layer) {
  return (layer.kind == PageKind::kColour || layer.kind == PageKind::kOverlay) && layer.is_whole();
}

std::optional<float> NumberWithin(std::string_view text, double least, double most) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= least && value <= most)) {
    return std::nullopt;
  }
  return static_cast<float>(value);
}

Result<NamedLayer> LayerOf(std::string_view text, const LayerTable& table) {
  const size_t end = std::min(text.find(':'), text.size());
  const std::string name(text.substr(0, end));
  const Layer* layer = table.Find(name);
  if (layer == nullptr || !IsImage(*layer)) {
    std::vector<std::string> known;
    for (const Layer& each : table.layers()) {
      if (IsImage(each)) known.push_back(each.name);
    }
    const std::string nearest = NearestWord(name, known);
    return Status::Error("no image layer is called \"{}\"; {}", name,
                         nearest.empty() ? fmt::format("there are {}", fmt::join(known, ", "))
                                         : fmt::format("did you mean {}?", nearest));
  }
  NamedLayer named{name, {}};
  named.use.type = layer->type;
  named.use.role = layer->role;
  std::string_view rest = text.substr(end);
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const size_t next = std::min(rest.find(':'), rest.size());
    if (Status status = ApplyLayerSetting(rest.substr(0, next), named.use); !status.ok()) {
      return Status::Error("layer {}: {}", name, status.message());
    }
    rest.remove_prefix(next);
  }
  return named;
}

}  // namespace

Status ApplyLayerSetting(std::string_view setting, LayerUse& use) {
  if (setting == "on" || setting == "off") {
    use.on = setting == "on";
    return {};
  }
  const size_t equals = std::min(setting.find('='), setting.size());
  const std::string_view key = setting.substr(0, equals);
  const std::string_view value = setting.substr(std::min(equals + 1, setting.size()));
  if (key == "role") {
    const auto role = std::find_if(kRoles.begin(), kRoles.end(), [&](const auto& each) { return each.first == value; });
    if (role == kRoles.end()) return Status::Error("\"{}\" is wrong; {}", setting, kUsage);
    use.role = role->second;
    return {};
  }
  const auto set = [&](float& target, double least, double most) -> Status {
    const auto number = NumberWithin(value, least, most);
    if (!number) return Status::Error("\"{}\" is wrong; {}", setting, kUsage);
    target = *number;
    return {};
  };
  if (key == "opacity") return set(use.opacity, 0, 1);
  if (key == "gamma") return set(use.gamma, 0.1, 10);
  if (key == "multiplier") return set(use.multiplier, 0, 100);
  return Status::Error("\"{}\" is wrong; {}", setting, kUsage);
}

Result<std::vector<NamedLayer>> LayersOf(const std::vector<std::string>& texts, const LayerTable& table) {
  std::vector<NamedLayer> layers;
  if (texts.empty()) {
    const auto add = [&](const Layer& layer) {
      if (layers.size() < kMaxImageLayers) layers.push_back({layer.name, LayerUse{layer.type, layer.role}});
    };
    const auto colour = std::find_if(table.layers().begin(), table.layers().end(), [](const Layer& layer) {
      return layer.kind == PageKind::kColour && !layer.is_made;
    });
    if (colour != table.layers().end()) add(*colour);
    for (const Layer& layer : table.layers()) {
      if (IsImage(layer) && layer.role == LayerRole::kMultiply) add(layer);
    }
    return layers;
  }
  if (texts.size() > kMaxImageLayers) {
    return Status::Error("{} image layers asked for, but at most {} are drawn over each other", texts.size(),
                         kMaxImageLayers);
  }
  for (const std::string& text : texts) {
    Result<NamedLayer> layer = LayerOf(text, table);
    if (!layer.ok()) return layer.status();
    const bool twice =
        std::any_of(layers.begin(), layers.end(), [&](const NamedLayer& each) { return each.name == layer->name; });
    if (twice) return Status::Error("layer {} is named twice", layer->name);
    layers.push_back(std::move(*layer));
  }
  return layers;
}

std::vector<LayerUse> UsesOf(const std::vector<NamedLayer>& layers) {
  std::vector<LayerUse> uses;
  uses.reserve(layers.size());
  for (const NamedLayer& layer : layers) uses.push_back(layer.use);
  return uses;
}

}  // namespace belvedere

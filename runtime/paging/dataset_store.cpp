#include "runtime/paging/dataset_store.h"

#include "runtime/base/iso_time.h"

#include <nlohmann/json.hpp>

namespace belvedere::store {
namespace {

using nlohmann::json;

json SourceToJson(const SourceRecord& source) {
  json out = {{"path", source.path},
              {"crs", source.crs},
              {"extent_deg",
               {source.extent.west_deg, source.extent.south_deg, source.extent.east_deg, source.extent.north_deg}},
              {"nodata", nullptr},
              {"datum", source.datum},
              {"finest_level", source.finest_level}};
  if (source.nodata) out["nodata"] = *source.nodata;
  if (source.utc_s) out["time"] = FormatIsoTime(*source.utc_s);
  if (source.colour_fit) out["colour_fit"] = {{"gain", source.colour_fit->gain}, {"offset", source.colour_fit->offset}};
  if (!source.settings.empty()) out["settings"] = json::parse(source.settings);
  if (!source.state.empty()) out["state"] = source.state;
  return out;
}

double TimeFromJson(const json& in) {
  const auto text = in.get<std::string>();
  const std::optional<double> utc_s = ParseIsoTime(text);
  if (!utc_s) throw json::other_error::create(501, "\"" + text + "\" is no time", nullptr);
  return *utc_s;
}

json StepToJson(const StepOf& step) {
  json out = {{"layer", step.layer}, {"time", FormatIsoTime(step.utc_s)}};
  if (step.repeats == Repeats::kEveryYear) out["repeats"] = "year";
  return out;
}

StepOf StepFromJson(const json& in) {
  StepOf step{in.at("layer").get<std::string>(), TimeFromJson(in.at("time")), Repeats::kNever};
  if (!in.contains("repeats")) return step;
  const auto repeats = in.at("repeats").get<std::string>();
  if (repeats != "year") throw json::other_error::create(501, "a layer that repeats every " + repeats, nullptr);
  step.repeats = Repeats::kEveryYear;
  return step;
}

SourceRecord SourceFromJson(const json& in) {
  SourceRecord source;
  source.path = in.at("path").get<std::string>();
  source.crs = in.at("crs").get<std::string>();
  const auto& extent = in.at("extent_deg");
  source.extent = {extent.at(0).get<double>(), extent.at(1).get<double>(), extent.at(2).get<double>(),
                   extent.at(3).get<double>()};
  if (!in.at("nodata").is_null()) source.nodata = in.at("nodata").get<double>();
  source.datum = in.at("datum").get<std::string>();
  source.finest_level = in.at("finest_level").get<int>();
  if (in.contains("time")) source.utc_s = TimeFromJson(in.at("time"));
  if (in.contains("colour_fit")) {
    const json& fit = in.at("colour_fit");
    source.colour_fit = {fit.at("gain").get<std::array<double, 3>>(), fit.at("offset").get<std::array<double, 3>>()};
  }
  if (in.contains("settings")) source.settings = in.at("settings").dump();
  source.state = in.value("state", std::string());
  return source;
}

json LayerToJson(const LayerRecord& layer) {
  json sources = json::array();
  for (const auto& source : layer.sources) sources.push_back(SourceToJson(source));
  json out = {{"name", layer.name},
              {"kind", LayerKindName(layer.kind)},
              {"max_level", layer.max_level},
              {"pages_per_level", layer.pages_per_level},
              {"pages", layer.pages},
              {"bytes", layer.bytes},
              {"vertical_reference", layer.vertical_reference},
              {"sources", sources}};
  if (layer.step) out["step_of"] = StepToJson(*layer.step);
  if (layer.rules != 0) out["rules"] = layer.rules;
  if (layer.finest_last) out["priority"] = "resolution";
  if (layer.property) out["property"] = json::parse(PropertyToJson(*layer.property));
  if (layer.derivation) {
    out["made_of"] = {{"type", layer.derivation->type}, {"layer", layer.derivation->of}};
    if (!layer.derivation->definition.empty()) out["made_of"]["definition"] = json::parse(layer.derivation->definition);
  }
  return out;
}

LayerRecord LayerFromJson(const json& in) {
  LayerRecord layer;
  layer.name = in.at("name").get<std::string>();
  const auto kind = in.at("kind").get<std::string>();
  for (const LayerKind known : kLayerKinds) {
    if (kind == LayerKindName(known)) layer.kind = known;
  }
  if (kind != LayerKindName(layer.kind)) throw json::other_error::create(501, "unknown layer kind " + kind, nullptr);
  layer.max_level = in.at("max_level").get<int>();
  layer.pages_per_level = in.at("pages_per_level").get<std::vector<int64_t>>();
  layer.pages = in.at("pages").get<int64_t>();
  layer.bytes = in.at("bytes").get<int64_t>();
  layer.vertical_reference = in.at("vertical_reference").get<std::string>();
  for (const auto& source : in.at("sources")) layer.sources.push_back(SourceFromJson(source));
  if (in.contains("step_of") && layer.kind == LayerKind::kImagery) layer.step = StepFromJson(in.at("step_of"));
  layer.rules = in.value("rules", 0);
  layer.finest_last = in.value("priority", std::string()) == "resolution";
  if (layer.kind == LayerKind::kProperty) layer.property = PropertyFromJson(in.at("property").dump());
  if (in.contains("made_of")) {
    const json& made = in.at("made_of");
    layer.derivation = {made.at("type").get<std::string>(), made.at("layer").get<std::string>(),
                        made.contains("definition") ? made.at("definition").dump() : std::string()};
  }
  return layer;
}

}  // namespace

std::string PropertyToJson(const PropertyRecord& property) {
  json out = {{"channels", property.channels}};
  for (const PropertyClass& one : property.classes)
    out["classes"].push_back({{"name", one.name}, {"colour", one.colour}});
  if (!property.classes.empty()) return out.dump();
  out["offset"] = property.offset;
  out["gain"] = property.gain;
  out["unit"] = property.unit;
  return out.dump();
}

PropertyRecord PropertyFromJson(std::string_view text) {
  const json in = json::parse(text);
  PropertyRecord property;
  property.channels = in.at("channels").get<int>();
  if (property.channels < 1 || property.channels > kMostPropertyChannels)
    throw json::other_error::create(501, "a property of " + std::to_string(property.channels) + " channels", nullptr);
  if (in.contains("classes")) {
    for (const json& one : in.at("classes"))
      property.classes.push_back({one.at("name").get<std::string>(), one.at("colour").get<std::array<uint8_t, 4>>()});
  }
  property.offset = in.value("offset", 0.0);
  property.gain = in.value("gain", 1.0);
  property.unit = in.value("unit", std::string());
  return property;
}

std::string ToJson(const Metadata& metadata) {
  json layers = json::array();
  for (const auto& layer : metadata.layers) layers.push_back(LayerToJson(layer));
  json out = {{"format", "belvedere dataset"},
              {"version", kDatasetVersion},
              {"build_time", metadata.build_time},
              {"layers", layers}};
  if (!metadata.id.empty()) out["id"] = metadata.id;
  if (!metadata.over.empty()) out["over"] = metadata.over;
  if (!metadata.features.empty()) out["features"] = metadata.features;
  return out.dump(1);
}

Result<Metadata> FromJson(std::string_view text) {
  try {
    const json in = json::parse(text);
    const int version = in.at("version").get<int>();
    if (version < kOldestDatasetVersion || version > kDatasetVersion) {
      return Status::Error("dataset of version {}, this program reads versions {} to {}; build it again", version,
                           kOldestDatasetVersion, kDatasetVersion);
    }
    Metadata metadata;
    metadata.version = version;
    metadata.build_time = in.at("build_time").get<std::string>();
    metadata.id = in.value("id", std::string());
    metadata.over = in.value("over", std::string());
    metadata.features = in.value("features", std::string());
    if (metadata.features.find('/') != std::string::npos)
      return Status::Error("its features are said to be in {}, outside of it; build it again", metadata.features);
    for (const auto& layer : in.at("layers")) metadata.layers.push_back(LayerFromJson(layer));
    if (metadata.layers.size() > static_cast<size_t>(kMaxDatasetLayers)) {
      return Status::Error("{} layers, more than {}", metadata.layers.size(), kMaxDatasetLayers);
    }
    return metadata;
  } catch (const std::exception& problem) {
    return Status::Error("metadata is damaged ({}); build it again", problem.what());
  }
}

}  // namespace belvedere::store

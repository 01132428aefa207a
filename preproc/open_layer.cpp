#include "preproc/open_layer.h"

#include "preproc/composite.h"
#include "preproc/source_path.h"

#include <gdal_priv.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace belvedere {
namespace {

constexpr int64_t kGdalCacheBytes = int64_t{64} << 20;

}  // namespace

void OpenLayer::Add(std::unique_ptr<RasterSource> source) {
  const Georeference& georeference = source->georeference();
  plan.push_back({georeference.extent(), FinestLevel(georeference.spacing_deg(), spec.kind), georeference.spacing_deg(),
                  source->spec().utc_s.has_value()});
  sources.push_back(std::move(source));
}

void OpenLayer::PutInOrder() {
  if (spec.priority != Priority::kResolution) return;
  OpenLayer sorted;
  for (const size_t place : PlacesByResolution(plan)) {
    sorted.sources.push_back(std::move(sources[place]));
    sorted.plan.push_back(plan[place]);
  }
  sources = std::move(sorted.sources);
  plan = std::move(sorted.plan);
}

std::vector<RasterSource*> OpenLayer::pointers() const {
  std::vector<RasterSource*> out;
  out.reserve(sources.size());
  for (const auto& source : sources) out.push_back(source.get());
  return out;
}

std::vector<SourceRecord> OpenLayer::FeatureRecords() const {
  std::vector<SourceRecord> records;
  records.reserve(features.size());
  for (const FeatureSource& source : features) records.push_back(source.Record());
  return records;
}

LayerRecord OpenLayer::Record(const Geoid& geoid) const {
  LayerRecord record;
  record.name = spec.name;
  record.kind = spec.kind;
  record.step = spec.step;
  record.rules = kBuilderRules;
  record.finest_last = spec.priority == Priority::kResolution;
  if (spec.derived) record.derivation = {spec.derived->type.name, spec.derived->of, TypeToJson(spec.derived->type)};
  if (spec.kind == LayerKind::kProperty) record.property = spec.derived->type.property;
  if (spec.kind == LayerKind::kElevation)
    record.vertical_reference = "WGS 84 ellipsoid; mean sea level lifted by " + geoid.path();
  for (size_t i = 0; i < sources.size(); ++i) {
    record.sources.push_back(sources[i]->Record());
    record.sources.back().finest_level = plan[i].finest_level;
  }
  for (SourceRecord& source : FeatureRecords()) record.sources.push_back(std::move(source));
  return record;
}

namespace {

std::shared_ptr<const LineCorrection> CorrectionOf(const OpenLayer& ground, std::span<const OpenLayer> layers,
                                                   const Geoid& geoid) {
  auto correction = std::make_shared<LineCorrection>();
  Composite heights(LayerKind::kElevation, ground.pointers(), geoid);
  const auto height_at = [&](double latitude_deg, double longitude_deg) {
    return heights.HeightAt(latitude_deg, longitude_deg, ground.plan);
  };
  for (const OpenLayer& vectors : layers) {
    for (const FeatureSource& source : vectors.features) {
      const FeatureSelection& selection = *source.spec().features;
      if (selection.corrects == ground.spec.name) correction->Add(source.features(), selection.width_m, height_at);
    }
  }
  return correction->empty() ? nullptr : correction;
}

}  // namespace

void CorrectAlongLines(std::span<OpenLayer> layers, const Geoid& geoid) {
  std::set<std::string> grounds;
  for (OpenLayer& layer : layers) {
    if (layer.spec.kind != LayerKind::kElevation) continue;
    grounds.insert(layer.spec.name);
    layer.correction = CorrectionOf(layer, layers, geoid);
  }
  for (OpenLayer& vectors : layers) {
    for (FeatureSource& source : vectors.features) {
      const std::string& ground = source.spec().features->corrects;
      if (!ground.empty() && !grounds.contains(ground))
        source.AddRemark(fmt::format("there is no elevation layer {} that it could correct", ground));
    }
  }
}

std::optional<int> ParentOf(const LayerSpec& derived, std::span<const OpenLayer> layers) {
  for (size_t i = 0; i < layers.size(); ++i) {
    if (IsMadeOf(derived, layers[i].spec)) return static_cast<int>(i);
  }
  return std::nullopt;
}

void PrepareGdal(std::span<const LayerSpec> layers) {
  GDALAllRegister();
  CPLSetErrorHandler(CPLQuietErrorHandler);
  GDALSetCacheMax64(kGdalCacheBytes);
  KeepOffNetwork(!std::any_of(layers.begin(), layers.end(), [](const LayerSpec& layer) {
    return std::any_of(layer.sources.begin(), layer.sources.end(),
                       [](const SourceSpec& source) { return NamesServer(source.path); });
  }));
}

}  // namespace belvedere

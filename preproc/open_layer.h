// OpenLayer: a layer of the spec with its sources open, the best last.
//
// Threads: values; sources are for any thread.
#pragma once

#include "preproc/colour_match.h"
#include "preproc/plan.h"
#include "preproc/raster_source.h"
#include "preproc/spec.h"
#include "preproc/vectors/feature_source.h"
#include "preproc/vectors/line_correction.h"
#include "runtime/earth/geoid.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace belvedere {

// Raised whenever the builder makes other pages of the same sources than it did: pages by two rules do not fit
// together.
inline constexpr int kBuilderRules = 2;

struct OpenLayer {
  LayerSpec spec;
  std::vector<std::unique_ptr<RasterSource>> sources;
  std::vector<PlannedSource> plan;                   // of the sources
  std::vector<FeatureSource> features;               // of a vector layer, in place of sources
  std::shared_ptr<const LineCorrection> correction;  // of an elevation layer, where vectors ask for it
  std::vector<Unmatched> unmatched;
  int parent = -1;  // of a derived layer: the place of the one that it is made of

  void Add(std::unique_ptr<RasterSource> source);
  // Once all are added: the finest comes last where the spec asks for it.
  void PutInOrder();
  std::vector<RasterSource*> pointers() const;
  std::vector<SourceRecord> FeatureRecords() const;
  // All that the dataset says of it but for its pages' counts.
  LayerRecord Record(const Geoid& geoid) const;
};

// Sets what the vector layers among them make of the ground of the elevation layers. Those without their elevation
// layer get a remark. REQUIRES: their features are not taken yet.
void CorrectAlongLines(std::span<OpenLayer> layers, const Geoid& geoid);

// The place among them of the layer that a derived one is made of; nothing where it is not there.
std::optional<int> ParentOf(const LayerSpec& derived, std::span<const OpenLayer> layers);

// Before any source is opened: GDAL's drivers and caches, and the network only where a source asks for it.
void PrepareGdal(std::span<const LayerSpec> layers);

}  // namespace belvedere

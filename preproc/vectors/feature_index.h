// FeatureIndex: the features of a dataset's vector layers in one SQLite file with SpatiaLite's spatial index, for
// questions: what is here, what is near, where is what has this name.
//
// One table for each vector layer, by its name: `geometry` (WGS 84 degrees, with a spatial index), `class`, `name`,
// `importance`, and `attributes`, a JSON object; the row's number is the feature's id in the layer's pages. Any
// program that opens SpatiaLite files can read it.
//
// Threads: one at a time.
#pragma once

#include "preproc/vectors/feature.h"
#include "runtime/base/status.h"
#include "runtime/earth/quadcode.h"
#include "runtime/paging/dataset.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

class GDALDataset;

namespace belvedere {

// A name for the index of a new dataset that no other has had.
std::string NewFeaturesFile();

class FeatureIndexWriter {
 public:
  // Replaces a file that is there.
  static Result<std::unique_ptr<FeatureIndexWriter>> Create(const std::string& path);
  ~FeatureIndexWriter();
  FeatureIndexWriter(const FeatureIndexWriter&) = delete;
  FeatureIndexWriter& operator=(const FeatureIndexWriter&) = delete;

  // layer: its name, of which there is no table yet.
  Status Add(const std::string& layer, std::span<const Feature> features);
  // Everything is in the file after this.
  Status Close();

 private:
  FeatureIndexWriter(const std::string& path, GDALDataset* file) : path_(path), file_(file) {}

  const std::string path_;
  GDALDataset* file_;
};

// A question. Every condition that is given has to hold.
struct FeatureQuery {
  std::string layer{};  // empty: all
  std::optional<FeatureClass> of{};
  std::optional<std::string> name{};  // a part of it; of A to Z, in capitals or not
  std::optional<GeoBox> box{};        // degrees; over 180 E where east is over 180
  // Degrees; the nearest come first, none further than so many metres.
  struct Near {
    double latitude_deg = 0, longitude_deg = 0, within_m = 1000;
  };
  std::optional<Near> near{};
  std::string where{};  // a condition in SQL
  int64_t limit = 100;
};

// Each feature found as a line of GeoJSON: `properties` has layer, id, class, importance, all attributes, and where the
// question says `near`, distance_m. In the order of the distance, else of importance. Returns how many there were.
Result<int64_t> QueryFeatures(const Dataset& dataset, const FeatureQuery& query,
                              const std::function<void(const std::string&)>& found);

}  // namespace belvedere

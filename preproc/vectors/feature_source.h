// FeatureSource: a file of features, anything that OGR reads, brought to WGS 84 and the Earth's grid.
//
// Curves become lines, heights of points are dropped, polygons of borders and coasts become their outlines. A feature
// without a usable place is left out, and the remark says how many there were. Tags that GDAL's driver for
// OpenStreetMap has in one field ("other_tags") are attributes like the others. Where a feature has no "name" but a
// "NAME" or "Name", it is called that.
//
// Threads: one at a time.
#pragma once

#include "preproc/spec.h"
#include "preproc/vectors/feature.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace belvedere {

class FeatureSource {
 public:
  // Reads all of it. REQUIRES: spec.features. Fails, with the reason alone, where it cannot be read to its end, or
  // has no such feature.
  static Result<FeatureSource> Read(const SourceSpec& spec);

  const SourceSpec& spec() const { return spec_; }
  const std::vector<Feature>& features() const { return features_; }  // ids from 0; none once they are taken
  std::vector<Feature> TakeFeatures() { return std::exchange(features_, {}); }
  // What the user should know of it; none as a rule.
  const std::vector<std::string>& remarks() const { return remarks_; }
  void AddRemark(std::string remark) { remarks_.push_back(std::move(remark)); }
  SourceRecord Record() const { return record_; }

 private:
  explicit FeatureSource(const SourceSpec& spec) : spec_(spec) {}

  SourceSpec spec_;
  std::vector<Feature> features_;
  std::vector<std::string> remarks_;
  SourceRecord record_;
};

// Degrees; over 180 E east is more than 180.
GeoBox ExtentOf(std::span<const Feature> features);

// PostgreSQL's hstore text, as in "a"=>"b","c"=>"d". What is damaged is left out.
std::map<std::string, std::string> ParseTags(std::string_view text);

}  // namespace belvedere

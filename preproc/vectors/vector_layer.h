// Vector layer: its pages, and the index of features, from features of all its sources.
//
// Threads: one at a time.
#pragma once

#include "preproc/vectors/feature_index.h"
#include "preproc/vectors/feature_source.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset_writer.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace belvedere {

// Those of all sources, one after the other; ids count on. The sources have none any more.
std::vector<Feature> TakeFeatures(std::span<FeatureSource> sources);

// number: the layer's in the dataset. batch_bytes: of a transaction.
Status MakeVectorLayer(int number, std::span<const Feature> features, int64_t batch_bytes, DatasetWriter& writer);

// The index of features of a dataset that is being written: made with the first layer that is added.
class FeatureIndexMaker {
 public:
  explicit FeatureIndexMaker(DatasetWriter& writer) : writer_(writer) {}
  Status Add(const std::string& layer, std::span<const Feature> features);
  // From here on the writer has it.
  Status Finish();

 private:
  DatasetWriter& writer_;
  std::string file_;
  std::unique_ptr<FeatureIndexWriter> index_;
};

}  // namespace belvedere

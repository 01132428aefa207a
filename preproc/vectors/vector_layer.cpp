#include "preproc/vectors/vector_layer.h"

#include "preproc/vectors/feature_cutter.h"
#include "runtime/paging/vector_codec.h"

#include <utility>

namespace belvedere {

std::vector<Feature> TakeFeatures(std::span<FeatureSource> sources) {
  std::vector<Feature> features;
  for (FeatureSource& source : sources) {
    for (Feature& feature : source.TakeFeatures()) {
      feature.id = static_cast<uint32_t>(features.size());
      features.push_back(std::move(feature));
    }
  }
  return features;
}

Status MakeVectorLayer(int number, std::span<const Feature> features, int64_t batch_bytes, DatasetWriter& writer) {
  int64_t uncommitted_bytes = 0;
  Status status = CutFeatures(features, [&](Quadcode node, const VectorPage& page) {
    const std::vector<uint8_t> bytes = EncodeVector(page);
    Status put = writer.Put(number, node, bytes);
    uncommitted_bytes += static_cast<int64_t>(bytes.size());
    if (!put.ok() || uncommitted_bytes < batch_bytes) return put;
    uncommitted_bytes = 0;
    return writer.Commit();
  });
  return status.ok() ? writer.Commit() : status;
}

Status FeatureIndexMaker::Add(const std::string& layer, std::span<const Feature> features) {
  if (!index_) {
    file_ = NewFeaturesFile();
    auto made = FeatureIndexWriter::Create(writer_.partial_folder() + "/" + file_);
    if (!made.ok()) return made.status();
    index_ = std::move(*made);
  }
  return index_->Add(layer, features);
}

Status FeatureIndexMaker::Finish() {
  if (!index_) return {};
  Status status = index_->Close();
  if (status.ok()) writer_.SetFeatures(file_);
  return status;
}

}  // namespace belvedere

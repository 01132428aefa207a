#include "preproc/resumed_pages.h"

#include <algorithm>

namespace belvedere {

ResumedPages::ResumedPages(DatasetWriter& writer, int layers) : writer_(writer) {
  for (int layer = 0; layer < layers; ++layer) words_.push_back(writer.Resumed(layer));
}

int64_t ResumedPages::pages() const {
  size_t pages = 0;
  for (const auto& words : words_) pages += words.size();
  return static_cast<int64_t>(pages);
}

bool ResumedPages::Exists(int layer, Quadcode node) const {
  const std::vector<uint64_t>& words = words_[static_cast<size_t>(layer)];
  return std::binary_search(words.begin(), words.end(), node.word());
}

std::optional<std::vector<uint8_t>> ResumedPages::Page(int layer, Quadcode node) const {
  return writer_.Get(layer, node);
}

std::optional<std::vector<uint8_t>> ResumedPages::Deviations(int layer, Quadcode node) const {
  return writer_.GetDeviations(layer, node);
}

}  // namespace belvedere

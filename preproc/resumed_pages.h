// ResumedPages: what a build that was interrupted has left of the dataset that is being made again. Pages are written
// after all that is under them, so where a page is there its whole quadtree is.
//
// Threads: all methods, any.
#pragma once

#include "preproc/known_pages.h"
#include "runtime/paging/dataset_writer.h"

#include <cstdint>
#include <vector>

namespace belvedere {

class ResumedPages final : public KnownPages {
 public:
  // The writer outlives it.
  ResumedPages(DatasetWriter& writer, int layers);

  int64_t pages() const;
  bool Knows(int layer, Quadcode node) const override { return Exists(layer, node); }
  bool Exists(int layer, Quadcode node) const override;
  std::optional<std::vector<uint8_t>> Page(int layer, Quadcode node) const override;
  std::optional<std::vector<uint8_t>> Deviations(int layer, Quadcode node) const override;

 private:
  DatasetWriter& writer_;
  std::vector<std::vector<uint64_t>> words_;  // by layer, ascending
};

}  // namespace belvedere

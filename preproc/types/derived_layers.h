// Derived layers: the pages of a layer that is made of another's, once the pages of that one are there. It has the
// quadnodes of the other.
//
// Threads: blocks the caller; runs a network (page_network.h) on so many workers.
#pragma once

#include "preproc/spec.h"
#include "preproc/types/process_modules.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset_writer.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace belvedere {

struct DerivedWork {
  int layer = 0;  // its number in the dataset
  int jobs = 1;
  int64_t batch_bytes = 0;  // of a transaction
  // The parent's page, as stored; nullopt where there is none.
  std::function<std::optional<std::vector<uint8_t>>(Quadcode)> parent_page;
  // Whether the page is there as it would be made; it is then left as it is.
  std::function<bool(Quadcode)> is_known;
};

// REQUIRES: IsMadeOf(layer, parent).
Status MakeDerivedLayer(const LayerSpec& layer, const LayerSpec& parent, const DerivedWork& work, const Geoid& sea,
                        DatasetWriter& writer);

}  // namespace belvedere

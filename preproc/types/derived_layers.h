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
#include <span>
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

// The place of the layer that it is made of, which comes before it; -1 where none is.
int ParentOf(std::span<const LayerSpec> layers, size_t derived);

// REQUIRES: the layer is derived, and its parent is of the type's parent.
Status MakeDerivedLayer(const DerivedSpec& spec, const DerivedWork& work, LayerKind parent,
                        const ModuleContext& context, DatasetWriter& writer);

}  // namespace belvedere

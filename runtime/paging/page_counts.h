// Page counts of a layer's record, page by page. Threads: pure functions.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/paging/dataset.h"

#include <cstddef>
#include <cstdint>

namespace belvedere {

inline void ClearCounts(LayerRecord& layer) {
  layer.pages = layer.bytes = 0;
  layer.max_level = 0;
  layer.pages_per_level.assign(1, 0);
}

// pages: 1 for one more, -1 for one less; 0 where only its bytes change, by so many.
inline void CountPage(LayerRecord& layer, Quadcode node, int pages, int64_t bytes) {
  const auto level = static_cast<size_t>(node.level());
  if (layer.pages_per_level.size() <= level) layer.pages_per_level.resize(level + 1);
  layer.pages_per_level[level] += pages;
  layer.pages += pages;
  layer.bytes += bytes;
  while (layer.pages_per_level.size() > 1 && layer.pages_per_level.back() == 0) layer.pages_per_level.pop_back();
  layer.max_level = static_cast<int>(layer.pages_per_level.size()) - 1;
}

}  // namespace belvedere

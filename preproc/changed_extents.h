// Changed extents: where a layer's pages may change when its sources do.
//
// Threads: pure functions.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/paging/dataset.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace belvedere {

// Whether the source was read by the same settings from files that have not changed.
bool IsOfSameFiles(const SourceRecord& a, const SourceRecord& b);

// Extents of the sources that are in one list and not at the same place in the other: with other settings, files that
// have changed, colours fitted otherwise, or another order. And of those over them whose voids are filled from what is
// below, which may change all over such a void: has_voids tells of a place in `after`. Both lists best last.
std::vector<GeoBox> ChangedExtents(std::span<const SourceRecord> before, std::span<const SourceRecord> after,
                                   const std::function<bool(size_t)>& has_voids);

// Whether any post or texel of the page, those of its neighbours that it holds among them, may lie in one of the
// extents. Where it is so of a page it is so of the pages above it.
bool Touches(std::span<const GeoBox> extents, LayerKind kind, Quadcode node);

}  // namespace belvedere

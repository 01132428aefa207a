// LayerSection: what the report's page shows of one layer.
//
// Units and frames: of preview.h.
// Threads: pure functions that read pages.
#pragma once

#include "runtime/base/status.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/dataset.h"

#include <string>
#include <vector>

namespace belvedere {

// A layer as the spec had it: itself, or its steps.
struct WholeLayer {
  std::string name;
  LayerKind kind = LayerKind::kElevation;
  std::vector<int> numbers;
};

std::vector<WholeLayer> WholeLayers(const Dataset& dataset);

// HTML: pictures, a map of levels and sources, tables of both, and of heights how they are spread.
Result<std::string> LayerSection(const Dataset& dataset, const WholeLayer& whole, const Geoid& geoid);

}  // namespace belvedere

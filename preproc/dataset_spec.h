// Dataset spec: what a dataset was built of, as it keeps it itself, and that with sources more or less.
//
// Layers of a dataset are numbered in their order, and a change leaves the numbers as they are: layers may be added at
// the end, and none goes away or comes between.
//
// Threads: pure functions.
#pragma once

#include "preproc/spec.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <string>

namespace belvedere {

// Steps are layers of their own. Fails where the dataset does not know its sources, or was built by other rules.
Result<BuildSpec> SpecOf(const Dataset& dataset);

// Sources come to the end of their layer, over those that are there; in a layer that changes with the time those
// without one lie under the pictures of every time. Layers that are new come to the end.
Result<BuildSpec> WithAdded(BuildSpec spec, const BuildSpec& added);
// source: its path as the spec wrote it, or as it is opened. layer: its name, or that of the whole that it is a step
// of; empty for all layers.
Result<BuildSpec> WithRemoved(BuildSpec spec, const std::string& source, const std::string& layer);

}  // namespace belvedere

// FeatureCutter: the pages of a vector layer, from its features (VectorPage).
//
// A page has what is at least 1 / 2048 of the quadnode's side large, simplified to that, and no more than
// kMostPointsOfPage points, the most important features first. It has children where that leaves something out, or
// moves something by more than its feature's resolution; else it is complete and holds its features as they are. Pages
// that are not complete have their points on a grid of 1 / 16384 of the side.
//
// Threads: pure functions. Memory: the features once more for each level that has some.
#pragma once

#include "preproc/vectors/feature.h"
#include "runtime/base/status.h"
#include "runtime/earth/quadcode.h"

#include <cstddef>
#include <functional>
#include <span>

namespace belvedere {

inline constexpr size_t kMostPointsOfPage = 8192;

// Every page of the layer, a page before its children, by quadcode; the first Status that is not ok ends it. A single
// feature may have more points than a page: then it is alone in it.
Status CutFeatures(std::span<const Feature> features, const std::function<Status(Quadcode, const VectorPage&)>& put);

}  // namespace belvedere

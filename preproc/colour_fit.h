// Colour fit: the gain and offset of each channel that take a source's colours closest to those of what lies below it.
//
// A linear fit a channel over the overlap, as in the AgentFly thesis. Clouds, snow and what was built meanwhile are no
// part of it: the first gain is the median of the slopes between pairs of samples, which holds with 29 % of the samples
// astray (Theil 1950; Sen 1968, "Estimates of the regression coefficient based on Kendall's tau"); then, again and
// again, least squares of the samples within 2.5 standard deviations, as their median distance tells these.
//
// The gain stays within [1/3, 3] and the offset within 128, so that no source loses all its contrast; a channel that is
// one colour only is shifted.
//
// Threads: pure functions; the same samples give the same fit.
#pragma once

#include "runtime/paging/dataset.h"

#include <array>
#include <span>

namespace belvedere {

// Of one position; 0 to 255.
struct ColourPair {
  std::array<float, 3> source{}, below{};
};

ColourFit FitColours(std::span<const ColourPair> pairs);

}  // namespace belvedere

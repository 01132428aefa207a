// Colour match: fits the sources of an imagery layer that ask for it to what lies below them, the lowest first, so that
// a source over a matched one is fitted to that as it will be seen.
//
// A source is sampled at 64 x 64 positions of its extent at most, two to a pixel of the coarsest source that counts
// below it and no closer, each as wide as such a pixel, so that both are equally smooth; where both are opaque a sample
// is a pair. With fewer than kLeastPairs of them a source is left as it is.
//
// Threads: one at a time, before pages are made.
#pragma once

#include "preproc/raster_source.h"
#include "runtime/earth/geoid.h"

#include <string>
#include <vector>

namespace belvedere {

inline constexpr int kLeastPairs = 64;  // 4 x 4 pixels' worth

struct Unmatched {
  const RasterSource* source = nullptr;
  std::string reason;
};

// sources: of an imagery layer, best last. Sets their fits; returns those that could not be matched.
std::vector<Unmatched> MatchColours(const std::vector<RasterSource*>& sources, const Geoid& geoid);

}  // namespace belvedere

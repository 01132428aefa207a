// Preview: small pictures of a layer for a report, made of its coarse pages alone.
//
// Imagery as it is, over light grey where it is transparent. Heights tinted by what they are above mean sea level, and
// shaded from the north-west, as strongly as makes the relief seen.
//
// Units: degrees. Frames: plate carree, the north on top.
// Threads: pure functions that read pages.
#pragma once

#include "preproc/picture.h"
#include "runtime/base/status.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/dataset.h"

#include <span>

namespace belvedere {

struct Preview {
  GeoBox box;
  int level = 0;  // of the pages it is made of
  Picture picture;
};

// What lies in the box, west under east, no more than `side` pixels each way.
Result<Preview> PreviewOf(const Dataset& dataset, int layer, const GeoBox& box, int side, const Geoid& geoid);

// The smallest box that holds all pages of the layer's finest level.
Result<GeoBox> FinestBox(const Dataset& dataset, int layer);

// A map of the Earth, width x width / 2: how fine the finest page is that touches each pixel, of all the layers.
Picture MapOfLevels(const Dataset& dataset, std::span<const int> layers, int width);
// What the map shows a level in: dark where coarse, bright where fine.
Rgb LevelColour(int level, int finest_level);

}  // namespace belvedere

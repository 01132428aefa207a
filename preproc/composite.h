// Composite: pages made of a layer's sources, the best last, at the exact positions of their posts or texels.
//
// Heights: where no source has data there is mean sea level. Images: where no source has data a texel is transparent
// black. A later source covers an earlier one where it has data; feathers and alpha blend the two. The voids of a
// source of heights are filled from below, shifted so as to meet its rim (void_fill.h); those of an image show what
// lies below.
//
// Threads: one Composite a thread.
#pragma once

#include "preproc/colour_fit.h"
#include "preproc/plan.h"
#include "preproc/source_sampler.h"
#include "preproc/void_fill.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/page.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace belvedere {

class Composite {
 public:
  // sources: best last. They and the geoid outlive the composite.
  Composite(LayerKind kind, const std::vector<RasterSource*>& sources, const Geoid& geoid);
  Composite(const Composite&) = delete;
  Composite& operator=(const Composite&) = delete;

  // Posts only; min, max and error are the caller's. REQUIRES: kind is elevation.
  std::vector<int32_t> Heights_mm(Quadcode node);
  // kImageSide^2 RGBA texels. REQUIRES: kind is imagery.
  std::vector<uint8_t> Texels(Quadcode node);
  // A source's colours, its place counted from the lowest, and those of what is below it, where both are opaque.
  // REQUIRES: kind is imagery.
  std::vector<ColourPair> ColourPairs(size_t place, const LatticeRows& lattice, const Spacing& spacing);
  // The height, in metres, that the sources have at a place, at the finest level that the plan of them has there.
  double HeightAt(double latitude_deg, double longitude_deg, std::span<const PlannedSource> plan);

 private:
  struct Heights {
    std::vector<double> metres;
    std::vector<int32_t> quanta_mm;  // what the sources of each are rounded to; 0 where there is none
  };
  struct Colours {
    std::vector<float> rgb;     // 3 a position, multiplied by how much of it is covered
    std::vector<float> shares;  // of a position that is not covered
    std::vector<bool> used;     // a sampler
  };
  // Of the samplers from `first` on.
  Colours ColoursAt(const LatticeRows& lattice, const Spacing& spacing, size_t first = 0);
  // Of the samplers from `first` on; level: of the lattice.
  Heights HeightsAt(const LatticeRows& lattice, const Spacing& spacing, int level, size_t first = 0);
  VoidFill::Ground GroundOf(size_t which, const LatticeRows& lattice, Quadcode node);
  bool MayCover(const SourceSampler& sampler, const LatticeRows& lattice) const;

  const LayerKind kind_;
  const Geoid& geoid_;
  std::vector<SourceSampler> samplers_;  // best first
  VoidFill void_fill_;
};

}  // namespace belvedere

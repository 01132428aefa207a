// LayerBuilder: makes the pages of one layer, depth first, children before their parent, each from the sources alone.
//
// A page reaches the sink after all that is under it, and none does that was made while a source could not be read: so
// where a page is in the dataset, everything under it is there and good.
//
// Threads: BuildTree, any of the workers; it runs tasks of its own.
#pragma once

#include "preproc/colour_match.h"
#include "preproc/composite.h"
#include "preproc/known_pages.h"
#include "preproc/page_sink.h"
#include "preproc/plan.h"
#include "preproc/progress.h"
#include "preproc/raster_source.h"
#include "preproc/surface_error.h"

#include <tbb/enumerable_thread_specific.h>

#include <memory>
#include <vector>

namespace belvedere {

struct OpenLayer {
  LayerSpec spec;
  std::vector<std::unique_ptr<RasterSource>> sources;
  std::vector<PlannedSource> plan;  // of the sources
  std::vector<Unmatched> unmatched;

  void PutFinestLast();
  std::vector<RasterSource*> pointers() const;
};

class LayerBuilder {
 public:
  // known and progress may be null. All outlive the builder.
  LayerBuilder(int number, const OpenLayer& layer, const Geoid& geoid, PageSink& sink, const KnownPages* known,
               Progress* progress);

  void BuildTree(Quadcode root);

 private:
  bool Stopped() const;
  void BuildImage(Quadcode node);
  BoundedPage BuildElevation(Quadcode node);
  BoundedPage TakeElevation(Quadcode node);
  bool NeedsRefinement(const ElevationPage& page, Quadcode node, int source_level);
  bool IsKnown(Quadcode node) const { return known_ != nullptr && known_->Knows(number_, node); }
  bool IsPlanned(Quadcode node) const;
  void CountDone(Quadcode node);
  void CountSpared(Quadcode node);

  const int number_;
  const OpenLayer& layer_;
  PageSink& sink_;
  const KnownPages* const known_;
  Progress* const progress_;
  tbb::enumerable_thread_specific<std::unique_ptr<Composite>> composites_;
};

}  // namespace belvedere

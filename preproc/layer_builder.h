// LayerBuilder: makes the pages of one layer, depth first, children before their parent, each from the sources alone.
//
// A page reaches the sink after all that is under it, and none does that was made while a source could not be read: so
// where a page is in the dataset, everything under it is there and good.
//
// Threads: BuildTree, any of the workers; it runs tasks of its own.
#pragma once

#include "preproc/composite.h"
#include "preproc/known_pages.h"
#include "preproc/open_layer.h"
#include "preproc/page_sink.h"
#include "preproc/progress.h"
#include "preproc/surface_error.h"
#include "preproc/units.h"

#include <tbb/enumerable_thread_specific.h>

#include <functional>
#include <memory>
#include <span>

namespace belvedere {

class LayerBuilder {
 public:
  // known and progress may be null. All outlive the builder.
  LayerBuilder(int number, const OpenLayer& layer, const Geoid& geoid, PageSink& sink, KnownPages* known,
               Progress* progress);

  int number() const { return number_; }
  // The quadnode and all under it.
  void BuildTree(Quadcode root);

 private:
  bool Stopped() const;
  void BuildImage(Quadcode node);
  BoundedPage BuildElevation(Quadcode node);
  BoundedPage TakeElevation(Quadcode node);
  bool IsKnown(Quadcode node) const { return known_ != nullptr && known_->Knows(number_, node); }
  void CountDone();
  void Take(Quadcode node);

  const int number_;
  const OpenLayer& layer_;
  PageSink& sink_;
  KnownPages* const known_;
  Progress* const progress_;
  tbb::enumerable_thread_specific<std::unique_ptr<Composite>> composites_;
};

// As many as the machine has cores where 0 are asked for.
int WorkersOf(int jobs);
// Runs work on so many workers of oneTBB's.
void OnWorkers(int jobs, const std::function<void()>& work);
// The pages of these units alone. builders: one for each layer that a unit is of, by its number().
void BuildUnits(std::span<const std::unique_ptr<LayerBuilder>> builders, std::span<const Unit> units, int jobs);
// All pages of all layers that are made of sources, by so many workers.
void BuildAllTrees(std::span<const std::unique_ptr<LayerBuilder>> builders, int jobs);

}  // namespace belvedere

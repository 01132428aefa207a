#include "preproc/layer_builder.h"

#include "preproc/deltas_from_children.h"
#include "preproc/deviation_codec.h"
#include "runtime/paging/page_codec.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

namespace belvedere {

LayerBuilder::LayerBuilder(int number, const OpenLayer& layer, const Geoid& geoid, PageSink& sink, KnownPages* known,
                           Progress* progress)
    : number_(number), layer_(layer), sink_(sink), known_(known), progress_(progress), composites_([&layer, &geoid] {
        return std::make_unique<Composite>(layer.spec.kind, layer.pointers(), geoid);
      }) {}

void LayerBuilder::BuildTree(Quadcode root) {
  if (IsKnown(root)) {
    Take(root);
  } else if (layer_.spec.kind == LayerKind::kElevation) {
    BuildElevation(root);
  } else {
    BuildImage(root);
  }
}

bool LayerBuilder::Stopped() const {
  return sink_.failed() ||
         std::any_of(layer_.sources.begin(), layer_.sources.end(), [](const auto& s) { return !s->failure().ok(); });
}

void LayerBuilder::BuildImage(Quadcode node) {
  if (Stopped()) return;
  if (IsKnown(node)) return Take(node);
  if (node.level() < SourceLevel(layer_.plan, node)) {
    tbb::task_group children;
    for (const int which : node.Children()) children.run([this, node, which] { BuildImage(node.Child(which)); });
    children.wait();
  }
  const std::vector<uint8_t> texels = composites_.local()->Texels(node);
  if (Stopped()) return;
  sink_.Put(number_, node, EncodeImage(texels));
  CountDone();
}

// Nothing where the build is stopped.
BoundedPage LayerBuilder::BuildElevation(Quadcode node) {
  if (Stopped()) return {};
  if (IsKnown(node)) return TakeElevation(node);
  std::array<BoundedPage, 4> finer;
  const bool has_children = node.level() < SourceLevel(layer_.plan, node);
  if (has_children) {
    tbb::task_group children;
    for (const int which : node.Children()) {
      BoundedPage& child = finer[static_cast<size_t>(which)];
      children.run([this, node, which, &child] { child = BuildElevation(node.Child(which)); });
    }
    children.wait();
    if (Stopped()) return {};
    HalveWide(node, finer);
  }
  // After the children, for the source's pixels that they were made of are at hand now.
  auto page = std::make_shared<ElevationPage>();
  page->heights_mm = composites_.local()->Heights_mm(node);
  if (layer_.correction) layer_.correction->Apply(node, page->heights_mm);
  BoundedPage bounded;
  if (has_children) {
    bounded.deviations = BoundPage(*page, &finer);
    page->deltas = DeltasFromChildren(node, *page, finer);
    for (const BoundedPage& child : finer) bounded.depth = std::max(bounded.depth, child.depth + 1);
  } else {
    bounded.deviations = BoundPage(*page, nullptr);
  }
  if (Stopped()) return {};
  sink_.Put(number_, node, EncodeElevation(*page),
            bounded.depth >= kDepthWithDeviations ? EncodeDeviations(bounded.deviations) : std::vector<uint8_t>());
  CountDone();
  bounded.page = std::move(page);
  return bounded;
}

BoundedPage LayerBuilder::TakeElevation(Quadcode node) {
  Take(node);
  auto bounded = ReadBounded(*known_, number_, node);
  if (bounded.ok()) return std::move(*bounded);
  sink_.Fail(Status::Error("layer {}: what was built before is damaged: {}; build it again, with --fresh",
                           layer_.spec.name, bounded.message()));
  return {};
}

void LayerBuilder::CountDone() {
  if (progress_ != nullptr) progress_->Done();
}

void LayerBuilder::Take(Quadcode node) {
  known_->Take(number_, node);
  if (progress_ != nullptr) progress_->Spare(CountNodesUnder(layer_.plan, node));
}

int WorkersOf(int jobs) {
  return jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void OnWorkers(int jobs, const std::function<void()>& work) {
  const tbb::global_control workers(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(jobs));
  tbb::task_arena arena(jobs);
  arena.execute(work);
}

void BuildUnits(std::span<const std::unique_ptr<LayerBuilder>> builders, std::span<const Unit> units, int jobs) {
  OnWorkers(jobs, [&] {
    tbb::task_group trees;
    for (const Unit& unit : units) {
      const auto found =
          std::find_if(builders.begin(), builders.end(), [&](const auto& one) { return one->number() == unit.layer; });
      trees.run([&builder = **found, node = unit.node] { builder.BuildTree(node); });
    }
    trees.wait();
  });
}

void BuildAllTrees(std::span<const std::unique_ptr<LayerBuilder>> builders, int jobs) {
  OnWorkers(jobs, [&] {
    tbb::task_group trees;
    for (const auto& builder : builders) {
      for (int tree = 0; tree < kTrees; ++tree) {
        trees.run([&builder = *builder, tree] { builder.BuildTree(Quadcode::Root(tree)); });
      }
    }
    trees.wait();
  });
}

}  // namespace belvedere

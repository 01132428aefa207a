#include "preproc/build.h"

#include "preproc/colour_match.h"
#include "preproc/composite.h"
#include "preproc/deltas_from_children.h"
#include "preproc/page_sink.h"
#include "preproc/plan.h"
#include "preproc/progress.h"
#include "preproc/raster_source.h"
#include "preproc/source_path.h"
#include "preproc/surface_error.h"
#include "runtime/base/log.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/dataset_writer.h"
#include "runtime/paging/page_codec.h"

#include <fmt/chrono.h>
#include <gdal_priv.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace belvedere {
namespace {

constexpr int64_t kGdalCacheBytes = int64_t{64} << 20;

struct OpenLayer {
  LayerSpec spec;
  std::vector<std::unique_ptr<RasterSource>> sources;
  std::vector<PlannedSource> plan;
  std::vector<Unmatched> unmatched;

  void PutFinestLast() {
    OpenLayer sorted;
    for (const size_t place : PlacesByResolution(plan)) {
      sorted.sources.push_back(std::move(sources[place]));
      sorted.plan.push_back(plan[place]);
    }
    sources = std::move(sorted.sources);
    plan = std::move(sorted.plan);
  }

  std::vector<RasterSource*> pointers() const {
    std::vector<RasterSource*> out;
    out.reserve(sources.size());
    for (const auto& source : sources) out.push_back(source.get());
    return out;
  }
};

bool AnyNamesServer(const BuildSpec& spec) {
  return std::any_of(spec.layers.begin(), spec.layers.end(), [](const LayerSpec& layer) {
    return std::any_of(layer.sources.begin(), layer.sources.end(),
                       [](const SourceSpec& source) { return NamesServer(source.path); });
  });
}

// Makes the pages of one layer, from any of the workers.
class LayerBuilder {
 public:
  LayerBuilder(int number, const OpenLayer& layer, const Geoid& geoid, PageSink& sink, Progress* progress)
      : number_(number), layer_(layer), sink_(sink), progress_(progress), composites_([&layer, &geoid] {
          return std::make_unique<Composite>(layer.spec.kind, layer.pointers(), geoid);
        }) {}

  void BuildTree(Quadcode root) {
    if (layer_.spec.kind == LayerKind::kElevation) {
      BuildElevation(root);
    } else {
      BuildImage(root);
    }
  }

 private:
  bool Stopped() const {
    return sink_.failed() ||
           std::any_of(layer_.sources.begin(), layer_.sources.end(), [](const auto& s) { return !s->failure().ok(); });
  }

  void BuildImage(Quadcode node) {
    if (Stopped()) return;
    if (node.level() < SourceLevel(layer_.plan, node)) {
      tbb::task_group children;
      for (int which = 0; which < 4; ++which) children.run([this, node, which] { BuildImage(node.Child(which)); });
      children.wait();
    }
    sink_.Put(number_, node, EncodeImage(composites_.local()->Texels(node)));
    CountDone(node, node.level());
  }

  BoundedPage BuildElevation(Quadcode node) {
    auto page = std::make_shared<ElevationPage>();
    page->heights_mm = composites_.local()->Heights_mm(node);
    const int source_level = SourceLevel(layer_.plan, node);
    if (Stopped()) return {page, CellDeviations(static_cast<size_t>(kCells) * kCells)};
    CellDeviations deviations;
    if (node.level() < source_level || NeedsRefinement(*page, node, source_level)) {
      std::array<BoundedPage, 4> finer;
      tbb::task_group children;
      for (size_t which = 0; which < 4; ++which) {
        children.run(
            [this, node, which, &finer] { finer[which] = BuildElevation(node.Child(static_cast<int>(which))); });
      }
      children.wait();
      deviations = BoundPage(*page, &finer);
      page->deltas = DeltasFromChildren(node, *page, finer);
    } else {
      deviations = BoundPage(*page, nullptr);
    }
    sink_.Put(number_, node, EncodeElevation(*page));
    CountDone(node, source_level);
    return {std::move(page), std::move(deviations)};
  }

  bool NeedsRefinement(const ElevationPage& page, Quadcode node, int source_level) {
    if (node.level() >= std::min(source_level + kRefineLevels, kMaxLevel)) return false;
    const std::vector<double> probes = composites_.local()->ProbeHeights(node);
    return ShareBeyond(page, probes, RefineTolerance_m(source_level)) > kRefineShare;
  }

  // Only pages that the plan counted.
  void CountDone(Quadcode node, int source_level) {
    if (progress_ == nullptr) return;
    if (node.is_root() || node.level() <= std::max(source_level, SourceLevel(layer_.plan, node.Parent())))
      progress_->Done();
  }

  const int number_;
  const OpenLayer& layer_;
  PageSink& sink_;
  Progress* const progress_;
  tbb::enumerable_thread_specific<std::unique_ptr<Composite>> composites_;
};

class Builder {
 public:
  Builder(const BuildSpec& spec, const BuildOptions& options, const Clock& clock)
      : spec_(spec), options_(options), clock_(clock), jobs_(JobsOf(options)) {}

  Result<BuildReport> Run() {
    const double start_s = clock_.NowSeconds();
    report_.jobs = jobs_;
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    GDALSetCacheMax64(kGdalCacheBytes);
    KeepOffNetwork(!AnyNamesServer(spec_));
    auto geoid = Geoid::LoadEgm96();
    if (!geoid.ok()) return geoid.status();
    // Each round without what the one before found to be useless; so at most one more than there are sources.
    for (;;) {
      layers_.clear();
      ++report_.rounds;
      const double round_s = clock_.NowSeconds();
      BlockCache cache(options_.cache_bytes);
      if (Status status = OpenSources(cache); !status.ok()) return status;
      const size_t left_out = excluded_.size();  // what could not be opened is in no page
      const double opened_s = clock_.NowSeconds();
      auto writer = DatasetWriter::Create(options_.out);
      if (!writer.ok()) return writer.status();
      for (OpenLayer& layer : layers_) {
        if (layer.spec.kind == LayerKind::kImagery) layer.unmatched = MatchColours(layer.pointers(), **geoid);
      }
      if (Status status = MakePages(**geoid, **writer); !status.ok()) return status;
      ExcludeUseless();
      const double made_s = clock_.NowSeconds();
      report_.opening_s += opened_s - round_s;
      report_.pages_s += made_s - opened_s;
      if (excluded_.size() > left_out) continue;
      if (Status status = Finish(**geoid, **writer); !status.ok()) return status;
      report_.finishing_s = clock_.NowSeconds() - made_s;
      report_.seconds = clock_.NowSeconds() - start_s;
      layers_.clear();  // before the cache goes
      return std::move(report_);
    }
  }

 private:
  static int JobsOf(const BuildOptions& options) {
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return options.jobs > 0 ? options.jobs : cores;
  }

  // A source without a time is in every step of a layer: it is left out of all.
  static std::string KeyOf(const LayerSpec& layer, const SourceSpec& source) {
    return (layer.step ? layer.step->layer : layer.name) + "\n" + source.written_path;
  }

  void Exclude(const LayerSpec& layer, const SourceSpec& source, const std::string& reason) {
    if (!excluded_.insert(KeyOf(layer, source)).second) return;
    report_.skipped.push_back({source.written_path, reason});
    LogWarning("{}: skipped: {}", source.path, reason);
  }

  // A step that has lost all sources of its own time is none.
  static bool IsWorthBuilding(const OpenLayer& layer) {
    return std::any_of(layer.sources.begin(), layer.sources.end(),
                       [&](const auto& source) { return !layer.spec.step || source->spec().utc_s; });
  }

  Status OpenSources(BlockCache& cache) {
    int number = 0;
    for (const LayerSpec& layer_spec : spec_.layers) {
      OpenLayer layer;
      layer.spec = layer_spec;
      for (const SourceSpec& source_spec : layer_spec.sources) {
        if (excluded_.contains(KeyOf(layer_spec, source_spec))) continue;
        auto source = RasterSource::Open(source_spec, layer_spec.kind, number++, jobs_, cache);
        if (!source.ok()) {
          Exclude(layer_spec, source_spec, source.message());
          continue;
        }
        const Georeference& georeference = (*source)->georeference();
        layer.plan.push_back({georeference.extent(), FinestLevel(georeference.spacing_deg(), layer_spec.kind),
                              georeference.spacing_deg(), source_spec.utc_s.has_value()});
        layer.sources.push_back(std::move(*source));
      }
      if (layer_spec.priority == Priority::kResolution) layer.PutFinestLast();
      if (IsWorthBuilding(layer)) layers_.push_back(std::move(layer));
    }
    if (!layers_.empty()) return {};
    return Status::Error("{}: nothing could be built, since no source could be used; the first was {}: {}", spec_.path,
                         report_.skipped.front().source, report_.skipped.front().reason);
  }

  Status MakePages(const Geoid& geoid, DatasetWriter& writer) {
    int64_t planned = 0;
    for (const OpenLayer& layer : layers_) planned += CountNodes(layer.plan);
    PageSink sink(writer);
    std::optional<Progress> progress;
    if (options_.show_progress)
      progress.emplace(planned, clock_, [&sink] { return Progress::Written{sink.pages(), sink.bytes()}; });
    std::vector<std::unique_ptr<LayerBuilder>> builders;
    for (size_t i = 0; i < layers_.size(); ++i) {
      builders.push_back(std::make_unique<LayerBuilder>(static_cast<int>(i), layers_[i], geoid, sink,
                                                        progress ? &*progress : nullptr));
    }
    const tbb::global_control workers(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(jobs_));
    tbb::task_arena arena(jobs_);
    arena.execute([&] {
      tbb::task_group trees;
      for (auto& builder : builders) {
        for (int tree = 0; tree < kTrees; ++tree) {
          trees.run([&builder = *builder, tree] { builder.BuildTree(Quadcode::Root(tree)); });
        }
      }
      trees.wait();
    });
    return sink.Close();
  }

  // Sources that could not be read to the end, and sources without one valid pixel.
  void ExcludeUseless() {
    for (const OpenLayer& layer : layers_) {
      for (const auto& source : layer.sources) {
        const Status failure = source->failure();
        if (!failure.ok()) {
          Exclude(layer.spec, source->spec(), failure.message() + "; get the file again");
        } else if (!source->used() && !source->HasData()) {
          Exclude(layer.spec, source->spec(), "it covers nothing: no pixel is valid; check its nodata and mask");
        }
      }
    }
  }

  // In any step, of a source that is in several.
  bool IsSeen(const std::string& key) const {
    return std::any_of(layers_.begin(), layers_.end(), [&](const OpenLayer& layer) {
      return std::any_of(layer.sources.begin(), layer.sources.end(), [&](const auto& source) {
        return source->used() && KeyOf(layer.spec, source->spec()) == key;
      });
    });
  }

  Status Finish(const Geoid& geoid, DatasetWriter& writer) {
    std::vector<LayerRecord> records;
    for (const OpenLayer& layer : layers_) {
      LayerRecord record;
      record.name = layer.spec.name;
      record.kind = layer.spec.kind;
      record.step = layer.spec.step;
      if (layer.spec.kind == LayerKind::kElevation) {
        record.vertical_reference = "WGS 84 ellipsoid; mean sea level lifted by " + geoid.path();
      }
      for (size_t i = 0; i < layer.sources.size(); ++i) {
        record.sources.push_back(layer.sources[i]->Record());
        record.sources.back().finest_level = layer.plan[i].finest_level;
        report_.bytes_read += layer.sources[i]->bytes_read();
        if (!layer.sources[i]->remark().empty()) Warn(*layer.sources[i], layer.sources[i]->remark());
        if (!IsSeen(KeyOf(layer.spec, layer.sources[i]->spec()))) {
          Warn(*layer.sources[i], "nothing of it is seen: later sources cover it all");
        }
      }
      for (const Unmatched& unmatched : layer.unmatched) Warn(*unmatched.source, unmatched.reason);
      records.push_back(std::move(record));
    }
    const std::string now =
        fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(clock_.UtcSeconds())));
    if (Status status = writer.Finish(std::move(records), now); !status.ok()) return status;
    const auto dataset = Dataset::Open(options_.out);
    if (!dataset.ok()) return dataset.status();
    report_.layers = (*dataset)->layers();
    report_.bytes = (*dataset)->bytes();
    for (const LayerRecord& layer : report_.layers) report_.pages += layer.pages;
    return {};
  }

  void Warn(const RasterSource& source, const std::string& reason) {
    const bool said = std::any_of(report_.warnings.begin(), report_.warnings.end(), [&](const SourceRemark& remark) {
      return remark.source == source.spec().written_path && remark.reason == reason;
    });
    if (said) return;  // of another step
    report_.warnings.push_back({source.spec().written_path, reason});
    LogWarning("{}: {}", source.spec().path, reason);
  }

  const BuildSpec& spec_;
  const BuildOptions& options_;
  const Clock& clock_;
  const int jobs_;
  std::set<std::string> excluded_;  // layer and source
  std::vector<OpenLayer> layers_;
  BuildReport report_;
};

}  // namespace

Result<BuildReport> Build(const BuildSpec& spec, const BuildOptions& options, const Clock& clock) {
  try {
    return Builder(spec, options, clock).Run();
  } catch (const std::exception& problem) {
    return Status::Error("{}: the build broke off: {}", spec.path, problem.what());
  }
}

}  // namespace belvedere

#include "preproc/build.h"

#include "preproc/colour_match.h"
#include "preproc/layer_builder.h"
#include "preproc/mosaic.h"
#include "preproc/resumed_pages.h"
#include "preproc/source_settings.h"
#include "preproc/types/derived_layers.h"
#include "preproc/vectors/vector_layer.h"
#include "runtime/base/iso_time.h"
#include "runtime/base/log.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/dataset_writer.h"

#include <gdal_priv.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace belvedere {
namespace {

class Builder {
 public:
  Builder(const BuildSpec& spec, const BuildOptions& options, const Clock& clock)
      : spec_(spec), options_(options), clock_(clock), jobs_(WorkersOf(options.jobs)) {}

  Result<BuildReport> Run() {
    const double start_s = clock_.NowSeconds();
    report_.jobs = jobs_;
    PrepareGdal(spec_.layers);
    for (UnusableFile& file : ExpandMosaics(spec_)) {
      LogWarning("{}: skipped: {}", file.path, file.reason);
      report_.skipped.push_back({std::move(file.path), std::move(file.reason)});
    }
    auto geoid = Geoid::LoadEgm96();
    if (!geoid.ok()) return geoid.status();
    // Each round without what the one before found to be useless; so at most one more than there are sources.
    for (;;) {
      layers_.clear();
      ++report_.rounds;
      const double round_s = clock_.NowSeconds();
      BlockCache cache(options_.cache_bytes);
      if (Status status = OpenSources(cache); !status.ok()) return status;
      if (made_of_.empty()) made_of_ = MadeOf(**geoid);
      if (IsShardWhole()) return std::move(report_);
      if (options_.merge > 0 && report_.rounds == 1) {
        if (Status status = Merge(); !status.ok()) return status;
      }
      auto writer = StartWriter();
      if (!writer.ok()) return writer.status();
      if (TakeNotes((*writer)->notes())) {
        layers_.clear();
        if (Status status = OpenSources(cache); !status.ok()) return status;
      }
      for (OpenLayer& layer : layers_) {
        if (layer.spec.kind == LayerKind::kImagery) layer.unmatched = MatchColours(layer.pointers(), **geoid);
      }
      CorrectAlongLines(layers_, **geoid);
      const size_t left_out = excluded_.size();  // what could not be opened is in no page
      const double opened_s = clock_.NowSeconds();
      if (Status status = MakePages(**geoid, **writer); !status.ok()) return status;
      ExcludeUseless();
      const double made_s = clock_.NowSeconds();
      report_.opening_s += opened_s - round_s;
      report_.pages_s += made_s - opened_s;
      if (excluded_.size() > left_out) continue;
      Status status = options_.shard ? FinishShard(**writer) : MakeVectors(**writer);
      if (status.ok() && !options_.shard) status = MakeDerived(**geoid, **writer);
      if (status.ok() && !options_.shard) status = Finish(**geoid, **writer);
      if (!status.ok()) return status;
      if (options_.merge > 0) RemoveShards(options_.out);
      report_.finishing_s = clock_.NowSeconds() - made_s;
      report_.seconds = clock_.NowSeconds() - start_s;
      layers_.clear();  // before the cache goes
      return std::move(report_);
    }
  }

 private:
  // A source without a time is in every step of a layer: it is left out of all.
  static std::string KeyOf(const LayerSpec& layer, const SourceSpec& source) {
    return (layer.step ? layer.step->layer : layer.name) + "\n" + SettingsToJson(source);
  }

  void Exclude(const LayerSpec& layer, const SourceSpec& source, const std::string& reason) {
    if (!excluded_.insert({KeyOf(layer, source), reason}).second) return;
    report_.skipped.push_back({NameOf(source), reason});
    LogWarning("{}: skipped: {}", source.path, reason);
  }

  // All that the pages depend on. What cannot be opened counts too: later it may be there.
  std::string MadeOf(const Geoid& geoid) const {
    std::string text = fmt::format("version {}, rules {}, GDAL {}\n{}", kDatasetVersion, kBuilderRules,
                                   GDALVersionInfo("RELEASE_NAME"), StateOfFiles({"/proc/self/exe", geoid.path()}));
    for (const LayerSpec& layer : spec_.layers) {
      text += fmt::format("{} {} {}\n", LayerKindName(layer.kind), layer.name, static_cast<int>(layer.priority));
      for (const SourceSpec& source : layer.sources) text += SettingsToJson(source) + "\n";
      if (layer.derived) text += layer.derived->of + TypeToJson(layer.derived->type) + "\n";
    }
    for (const OpenLayer& layer : layers_) {
      text += layer.spec.name + "\n";
      for (const auto& source : layer.sources) text += source->state();
      for (const FeatureSource& source : layer.features) text += source.Record().state;
    }
    return text;
  }

  Result<std::unique_ptr<DatasetWriter>> StartWriter() {
    const std::string path = options_.shard ? ShardPath(options_.out, *options_.shard) : options_.out;
    if (options_.shard) RemoveMark(options_.out, *options_.shard);
    if (options_.fresh && options_.merge == 0 && report_.rounds == 1) {
      if (Status status = DatasetWriter::Discard(path); !status.ok()) return status;
    }
    return DatasetWriter::Create(path, made_of_);
  }

  bool IsShardWhole() {
    if (!options_.shard || options_.fresh) return false;
    const auto pages = PagesOfWhole(options_.out, *options_.shard, made_of_);
    if (!pages) return false;
    report_.shard = options_.shard;
    report_.pages = report_.resumed = *pages;
    layers_.clear();
    return true;
  }

  Status FinishShard(DatasetWriter& writer) {
    report_.shard = options_.shard;
    Status status = writer.Note(Notes());
    if (status.ok()) status = writer.Leave();
    if (!status.ok()) return status;
    for (size_t i = 0; i < layers_.size(); ++i)
      report_.pages += static_cast<int64_t>(writer.Resumed(static_cast<int>(i)).size());
    return MarkWhole(options_.out, *options_.shard, made_of_, writer);
  }

  // Leaves a store that this build goes on from, as if it had been interrupted.
  Status Merge() {
    WaitForShards();
    auto writer = DatasetWriter::Create(options_.out, made_of_);
    if (!writer.ok()) return writer.status();
    const auto merged = MergeShards(options_.out, options_.merge, made_of_, options_.batch_bytes, **writer);
    if (!merged.ok()) return merged.status();
    for (const int number : merged->left_out)
      LogWarning("shard {} of {} was made with sources that others found to be bad: its pages are made anew", number,
                 options_.merge);
    return (*writer)->Leave();
  }

  // Others write marks into a folder that may be on another machine: nothing tells but to look.
  void WaitForShards() const {
    constexpr auto kPause = std::chrono::milliseconds(200);
    constexpr int kPausesALine = 50;
    for (int pauses = 0; options_.wait_for_shards; ++pauses) {
      std::string missing;
      for (int number = 1; number <= options_.merge; ++number) {
        if (!PagesOfWhole(options_.out, {number, options_.merge}, made_of_)) missing += fmt::format(" {}", number);
      }
      if (missing.empty()) return;
      if (pauses % kPausesALine == kPausesALine - 1) LogInfo("waits for shards{} of {}", missing, options_.merge);
      std::this_thread::sleep_for(kPause);
    }
  }

  // What a build that goes on from this one would not find out again.
  std::string Notes() const { return NotesToJson({excluded_, SeenKeys()}); }

  // Whether sources are left out that were opened.
  bool TakeNotes(const std::string& text) {
    const BuildNotes notes = NotesFromJson(text);
    seen_before_.insert(notes.seen.begin(), notes.seen.end());
    const size_t before = excluded_.size();
    for (const LayerSpec& layer : spec_.layers) {
      for (const SourceSpec& source : layer.sources) {
        const auto found = notes.skipped.find(KeyOf(layer, source));
        if (found != notes.skipped.end()) Exclude(layer, source, found->second);
      }
    }
    return excluded_.size() > before;
  }

  // A step that has lost all sources of its own time is none.
  static bool IsWorthBuilding(const OpenLayer& layer) {
    if (layer.spec.kind == LayerKind::kVector) return !layer.features.empty();
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
        if (source_spec.features) {
          auto features = FeatureSource::Read(source_spec);
          if (features.ok())
            layer.features.push_back(std::move(*features));
          else
            Exclude(layer_spec, source_spec, features.message());
          continue;
        }
        auto source = RasterSource::Open(source_spec, layer_spec.kind, number++, jobs_, cache);
        if (!source.ok()) {
          Exclude(layer_spec, source_spec, source.message());
          continue;
        }
        layer.Add(std::move(*source));
      }
      layer.PutInOrder();
      if (layer_spec.derived && !FindParent(layer)) continue;
      if (layer_spec.derived || IsWorthBuilding(layer)) layers_.push_back(std::move(layer));
    }
    if (!layers_.empty()) return {};
    return Status::Error("{}: nothing could be built, since no source could be used; the first was {}: {}", spec_.path,
                         report_.skipped.front().source, report_.skipped.front().reason);
  }

  bool FindParent(OpenLayer& derived) {
    const DerivedSpec& spec = *derived.spec.derived;
    derived.parent = ParentOf(derived.spec, layers_).value_or(-1);
    if (derived.parent >= 0) return true;
    const std::string reason =
        fmt::format("there is no layer {} of type \"{}\" that it could be made of", spec.of, spec.type.parent);
    if (!excluded_.insert({"layer " + derived.spec.name, reason}).second) return false;
    report_.skipped.push_back({derived.spec.name, reason});
    LogWarning("layer {}: skipped: {}", derived.spec.name, reason);
    return false;
  }

  Status MakeVectors(DatasetWriter& writer) {
    FeatureIndexMaker index(writer);
    for (size_t i = 0; i < layers_.size(); ++i) {
      if (layers_[i].features.empty()) continue;
      const std::vector<Feature> features = TakeFeatures(layers_[i].features);
      LogInfo("layer {}: {} features", layers_[i].spec.name, features.size());
      Status status = MakeVectorLayer(static_cast<int>(i), features, options_.batch_bytes, writer);
      if (status.ok()) status = index.Add(layers_[i].spec.name, features);
      if (!status.ok()) return status;
    }
    return index.Finish();
  }

  // Of the last round alone, which has all that they are made of.
  Status MakeDerived(const Geoid& geoid, DatasetWriter& writer) {
    for (size_t i = 0; i < layers_.size(); ++i) {
      const OpenLayer& layer = layers_[i];
      if (!layer.spec.derived) continue;
      const int number = static_cast<int>(i);
      const std::vector<uint64_t> known = writer.Resumed(number);
      const DerivedWork work{
          number, jobs_, options_.batch_bytes, [&](Quadcode node) { return writer.Get(layer.parent, node); },
          [&known](Quadcode node) { return std::binary_search(known.begin(), known.end(), node.word()); }};
      LogInfo("layer {} is made of layer {}", layer.spec.name, layer.spec.derived->of);
      const LayerSpec& parent = layers_[static_cast<size_t>(layer.parent)].spec;
      if (Status status = MakeDerivedLayer(layer.spec, parent, work, geoid, writer); !status.ok()) return status;
    }
    return {};
  }

  std::vector<Unit> UnitsOfShard() const {
    std::vector<Unit> all, own;
    for (size_t i = 0; i < layers_.size(); ++i) {
      if (!IsOfRasters(layers_[i].spec)) continue;  // made when shards are merged
      const std::vector<Unit> units = UnitsOf(static_cast<int>(i), layers_[i].plan);
      all.insert(all.end(), units.begin(), units.end());
    }
    const std::vector<int> shard_of = ShardsOf(all, options_.shard->of);
    for (size_t i = 0; i < all.size(); ++i) {
      if (shard_of[i] == options_.shard->number - 1) own.push_back(all[i]);
    }
    return own;
  }

  Status MakePages(const Geoid& geoid, DatasetWriter& writer) {
    int64_t planned = 0;
    const std::vector<Unit> units = options_.shard ? UnitsOfShard() : std::vector<Unit>();
    for (const Unit& unit : units) planned += unit.pages;
    for (const OpenLayer& layer : layers_)
      planned += !IsOfRasters(layer.spec) || options_.shard ? 0 : CountNodes(layer.plan);
    ResumedPages resumed(writer, static_cast<int>(layers_.size()));
    report_.resumed = resumed.pages();
    if (report_.resumed > 0)
      LogInfo("{}: goes on with {} pages of the build that was interrupted", options_.out, report_.resumed);
    PageSink sink(writer, options_.batch_bytes, [this] { return Notes(); });
    std::optional<Progress> progress;
    if (options_.show_progress)
      progress.emplace(planned, clock_, [&sink] { return Progress::Written{sink.pages(), sink.bytes()}; });
    std::vector<std::unique_ptr<LayerBuilder>> builders;
    for (size_t i = 0; i < layers_.size(); ++i) {
      if (!IsOfRasters(layers_[i].spec)) continue;
      builders.push_back(std::make_unique<LayerBuilder>(static_cast<int>(i), layers_[i], geoid, sink, &resumed,
                                                        progress ? &*progress : nullptr));
    }
    if (options_.shard)
      BuildUnits(builders, units, jobs_);
    else
      BuildAllTrees(builders, jobs_);
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

  // Sources of which something is seen, in any step where they are in several.
  std::set<std::string> SeenKeys() const {
    std::set<std::string> keys = seen_before_;
    for (const OpenLayer& layer : layers_) {
      for (const auto& source : layer.sources) {
        if (source->used()) keys.insert(KeyOf(layer.spec, source->spec()));
      }
    }
    return keys;
  }

  Status Finish(const Geoid& geoid, DatasetWriter& writer) {
    const std::set<std::string> seen = SeenKeys();
    std::vector<LayerRecord> records;
    for (const OpenLayer& layer : layers_) {
      for (size_t i = 0; i < layer.sources.size(); ++i) {
        report_.bytes_read += layer.sources[i]->bytes_read();
        if (!layer.sources[i]->remark().empty()) Warn(layer.sources[i]->spec(), layer.sources[i]->remark());
        if (!seen.contains(KeyOf(layer.spec, layer.sources[i]->spec()))) {
          Warn(layer.sources[i]->spec(), "nothing of it is seen: later sources cover it all");
        }
      }
      for (const Unmatched& unmatched : layer.unmatched) Warn(unmatched.source->spec(), unmatched.reason);
      for (const FeatureSource& source : layer.features) {
        for (const std::string& remark : source.remarks()) Warn(source.spec(), remark);
      }
      records.push_back(layer.Record(geoid));
    }
    const std::string now = FormatIsoTime(std::floor(clock_.UtcSeconds()));
    if (Status status = writer.Finish(std::move(records), now); !status.ok()) return status;
    const auto dataset = Dataset::Open(options_.out);
    if (!dataset.ok()) return dataset.status();
    report_.layers = (*dataset)->layers();
    report_.bytes = (*dataset)->bytes();
    for (const LayerRecord& layer : report_.layers) report_.pages += layer.pages;
    return {};
  }

  void Warn(const SourceSpec& source, const std::string& reason) {
    const bool said = std::any_of(report_.warnings.begin(), report_.warnings.end(), [&](const SourceRemark& remark) {
      return remark.source == NameOf(source) && remark.reason == reason;
    });
    if (said) return;  // of another step
    report_.warnings.push_back({NameOf(source), reason});
    LogWarning("{}: {}", source.path, reason);
  }

  BuildSpec spec_;  // the files that it names put together
  const BuildOptions& options_;
  const Clock& clock_;
  const int jobs_;
  std::map<std::string, std::string> excluded_;  // layer and source, and why
  std::set<std::string> seen_before_;            // by the build that this one goes on from
  std::string made_of_;
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

#include "preproc/update.h"

#include "preproc/changed_extents.h"
#include "preproc/dataset_spec.h"
#include "preproc/georeference.h"
#include "preproc/layer_builder.h"
#include "preproc/mosaic.h"
#include "preproc/open_layer.h"
#include "preproc/page_sink.h"
#include "preproc/source_settings.h"
#include "preproc/types/derived_layers.h"
#include "preproc/vectors/vector_layer.h"
#include "runtime/base/iso_time.h"
#include "runtime/base/log.h"
#include "runtime/base/mutex.h"
#include "runtime/paging/change_writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

// Pages of the dataset as it was, where nothing touches them.
class UnchangedPages final : public KnownPages {
 public:
  explicit UnchangedPages(const Dataset& dataset) : dataset_(dataset) {}

  // Of the next layer: where its sources change.
  void Add(std::vector<GeoBox> extents) { extents_.push_back(std::move(extents)); }
  bool AnyChange() const {
    return std::any_of(extents_.begin(), extents_.end(), [](const auto& extents) { return !extents.empty(); });
  }

  bool Knows(int layer, Quadcode node) const override {
    return Exists(layer, node) &&
           !Touches(extents_[static_cast<size_t>(layer)], dataset_.layers()[static_cast<size_t>(layer)].kind, node);
  }
  bool Exists(int layer, Quadcode node) const override {
    return static_cast<size_t>(layer) < dataset_.layers().size() && dataset_.Exists(layer, node);
  }
  std::optional<std::vector<uint8_t>> Page(int layer, Quadcode node) const override {
    return dataset_.ReadRaw(layer, node);
  }
  std::optional<std::vector<uint8_t>> Deviations(int layer, Quadcode node) const override {
    return dataset_.ReadDeviations(layer, node);
  }

  void Take(int layer, Quadcode node) override EXCLUDES_LOCK(mutex_) {
    const MutexLock lock(mutex_);
    taken_.insert({layer, node.word()});
  }
  bool IsTaken(int layer, Quadcode node) const EXCLUDES_LOCK(mutex_) {
    const MutexLock lock(mutex_);
    return taken_.contains({layer, node.word()});
  }

 private:
  const Dataset& dataset_;
  std::vector<std::vector<GeoBox>> extents_;  // by layer
  mutable Mutex mutex_;
  std::set<std::pair<int, uint64_t>> taken_ GUARDED_BY(mutex_);  // layers and quadcode words
};

class Updater {
 public:
  Updater(const BuildOptions& options, const Clock& clock)
      : options_(options), clock_(clock), jobs_(WorkersOf(options.jobs)), cache_(options.cache_bytes) {}

  Result<BuildReport> Run(const SpecChange& change) {
    const double start_s = clock_.NowSeconds();
    report_.jobs = jobs_;
    report_.rounds = 1;
    report_.is_change = true;
    if (Status status = Apply(change, start_s); !status.ok()) return status;
    if (Status status = Describe(); !status.ok()) return status;
    report_.seconds = clock_.NowSeconds() - start_s;
    report_.finishing_s = report_.seconds - report_.opening_s - report_.pages_s;
    return std::move(report_);
  }

 private:
  Status Apply(const SpecChange& change, double start_s) {
    const auto writer = ChangeWriter::Create(options_.out);
    if (!writer.ok()) return writer.status();
    const Dataset& before = (*writer)->before();
    auto spec = SpecOf(before);
    if (spec.ok()) spec = change(std::move(*spec));
    if (!spec.ok()) return spec.status();
    PrepareGdal(spec->layers);
    for (const UnusableFile& file : ExpandMosaics(*spec)) Warn(file.path, "skipped: " + file.reason);
    const auto geoid = Geoid::LoadEgm96();
    if (!geoid.ok()) return geoid.status();
    if (Status status = OpenSources(*spec); !status.ok()) return status;
    for (OpenLayer& layer : layers_) {
      if (layer.spec.kind == LayerKind::kImagery) layer.unmatched = MatchColours(layer.pointers(), **geoid);
    }
    CorrectAlongLines(layers_, **geoid);
    std::vector<LayerRecord> records;
    records.reserve(layers_.size());
    for (const OpenLayer& layer : layers_) records.push_back(layer.Record(**geoid));
    UnchangedPages unchanged(before);
    if (Status status = Compare(before, records, unchanged); !status.ok()) return status;
    report_.opening_s = clock_.NowSeconds() - start_s;
    if (!unchanged.AnyChange()) return {};
    if (Status status = MakePages(**geoid, unchanged, **writer); !status.ok()) return status;
    report_.pages_s = clock_.NowSeconds() - start_s - report_.opening_s;
    report_.written = (*writer)->written();
    report_.removed = (*writer)->removed();
    return (*writer)->Finish(std::move(records), FormatIsoTime(std::floor(clock_.UtcSeconds())));
  }

  Status OpenSources(const BuildSpec& spec) {
    int number = 0;
    for (const LayerSpec& layer_spec : spec.layers) {
      OpenLayer layer;
      layer.spec = layer_spec;
      for (const SourceSpec& source_spec : layer_spec.sources) {
        if (source_spec.features) {
          auto features = FeatureSource::Read(source_spec);
          if (!features.ok()) return Refusal(source_spec, features.message());
          layer.features.push_back(std::move(*features));
          continue;
        }
        auto source = RasterSource::Open(source_spec, layer_spec.kind, number++, jobs_, cache_);
        if (!source.ok()) return Refusal(source_spec, source.message());
        layer.Add(std::move(*source));
      }
      layer.PutInOrder();
      layer.parent = ParentOf(layer_spec, layers_).value_or(-1);
      if (layer_spec.derived && layer.parent < 0)
        return Status::Error("layer {}: there is no layer {} before it; the dataset {} is unchanged", layer_spec.name,
                             layer_spec.derived->of, options_.out);
      layers_.push_back(std::move(layer));
    }
    return {};
  }

  Status Refusal(const SourceSpec& source, const std::string& reason) const {
    return Status::Error("{}: {}; the dataset {} is unchanged", source.tiles.empty() ? source.path : NameOf(source),
                         reason, options_.out);
  }

  // What of the dataset stays, and whether it can.
  Status Compare(const Dataset& before, const std::vector<LayerRecord>& after, UnchangedPages& unchanged) {
    for (size_t layer = 0; layer < after.size(); ++layer) {
      const bool is_new = layer >= before.layers().size();
      const LayerRecord* old = is_new ? nullptr : &before.layers()[layer];
      if (old != nullptr && old->vertical_reference != after[layer].vertical_reference) {
        return Status::Error("{}: its heights are above \"{}\", those of this machine above \"{}\"; build it again",
                             options_.out, old->vertical_reference, after[layer].vertical_reference);
      }
      if (layers_[layer].spec.kind == LayerKind::kVector && !layers_[layer].spec.derived) {
        const bool is_alike = old != nullptr && AreSourcesAlike(old->sources, after[layer].sources);
        vectors_change_ |= !is_alike;
        unchanged.Add(is_alike ? std::vector<GeoBox>() : std::vector<GeoBox>{{-180, -90, 180, 90}});
        continue;
      }
      std::vector<GeoBox> extents = ChangedExtents(
          is_new ? std::span<const SourceRecord>() : std::span<const SourceRecord>(old->sources), after[layer].sources,
          [&](size_t place) {
            return after[layer].kind == LayerKind::kElevation && layers_[layer].sources[place]->HasVoids();
          });
      if (layers_[layer].spec.derived && !IsDerivedAlike(old, after[layer])) extents.push_back({-180, -90, 180, 90});
      if (after[layer].kind == LayerKind::kElevation) AddCorrected(before.layers(), after[layer].name, extents);
      FindChanged(layer, old);
      unchanged.Add(std::move(extents));
    }
    return {};
  }

  // Where lines correct the elevation layer: all of a source's that has come, gone or changed, and each line whose
  // ground has changed somewhere.
  void AddCorrected(const std::vector<LayerRecord>& before, const std::string& elevation,
                    std::vector<GeoBox>& extents) const {
    const std::vector<GeoBox> of_ground = extents;
    const auto add = [&](const GeoBox& box, const FeatureSelection& selection) {
      extents.push_back(Widened(box, selection.width_m));
    };
    std::vector<SourceRecord> now, old;
    for (const OpenLayer& layer : layers_) {
      for (SourceRecord& record : layer.FeatureRecords()) now.push_back(std::move(record));
    }
    for (const LayerRecord& layer : before) {
      if (layer.kind == LayerKind::kVector) old.insert(old.end(), layer.sources.begin(), layer.sources.end());
    }
    for (const SourceRecord& record : old) {
      const auto spec = SettingsFromJson(record.settings);
      const bool corrects = spec.ok() && spec->features && spec->features->corrects == elevation;
      if (corrects && !Has(now, record)) add(record.extent, *spec->features);
    }
    for (const OpenLayer& layer : layers_) {
      for (const FeatureSource& source : layer.features) {
        const FeatureSelection& selection = *source.spec().features;
        if (selection.corrects != elevation) continue;
        if (!Has(old, source.Record())) {
          add(source.Record().extent, selection);
          continue;
        }
        for (const Feature& feature : source.features()) {
          const GeoBox box = ExtentOf(std::span(&feature, 1));
          const bool is_on_changed = std::any_of(of_ground.begin(), of_ground.end(),
                                                 [&](const GeoBox& changed) { return Overlap(changed, box); });
          if (is_on_changed) add(box, selection);
        }
      }
    }
  }

  static bool Has(const std::vector<SourceRecord>& sources, const SourceRecord& wanted) {
    return std::any_of(sources.begin(), sources.end(),
                       [&](const SourceRecord& other) { return IsOfSameFiles(other, wanted); });
  }

  static bool AreSourcesAlike(const std::vector<SourceRecord>& before, const std::vector<SourceRecord>& after) {
    return std::equal(before.begin(), before.end(), after.begin(), after.end(), IsOfSameFiles);
  }

  // Vector layers are made anew whole where any of their sources changes: only pages that differ are written.
  Status MakeVectors(UnchangedPages& unchanged, ChangeWriter& writer) {
    FeatureIndexMaker index(writer);
    for (size_t i = 0; i < layers_.size(); ++i) {
      if (layers_[i].features.empty()) continue;
      const int number = static_cast<int>(i);
      const LayerRecord* before = i < writer.before().layers().size() ? &writer.before().layers()[i] : nullptr;
      const std::vector<SourceRecord> records = layers_[i].FeatureRecords();
      const bool is_alike = before != nullptr && AreSourcesAlike(before->sources, records);
      if (is_alike) {
        for (const uint64_t word : writer.before().Nodes(number)) unchanged.Take(number, *Quadcode::FromWord(word));
      }
      for (size_t place = 0; place < records.size(); ++place) {
        if (before != nullptr && Has(before->sources, records[place])) continue;
        const FeatureSource& source = layers_[i].features[place];
        for (const std::string& remark : source.remarks()) Warn(NameOf(source.spec()), remark);
      }
      if (!vectors_change_) continue;
      const std::vector<Feature> features = TakeFeatures(layers_[i].features);
      Status status = is_alike ? Status() : MakeVectorLayer(number, features, options_.batch_bytes, writer);
      if (status.ok() && !is_alike) status = RemoveGone(number, unchanged, writer);
      if (status.ok()) status = index.Add(layers_[i].spec.name, features);
      if (!status.ok()) return status;
    }
    if (vectors_change_) return index.Finish();
    writer.SetFeatures(std::filesystem::path(writer.before().features_path()).filename().string());
    return {};
  }

  static bool IsDerivedAlike(const LayerRecord* before, const LayerRecord& after) {
    return before != nullptr && before->derivation && before->derivation->of == after.derivation->of &&
           before->derivation->definition == after.derivation->definition;
  }

  // Where what they are made of was made anew.
  Status MakeDerived(const Geoid& geoid, UnchangedPages& unchanged, ChangeWriter& writer) {
    const std::vector<LayerRecord>& before = writer.before().layers();
    for (size_t i = 0; i < layers_.size(); ++i) {
      const OpenLayer& layer = layers_[i];
      if (!layer.spec.derived) continue;
      const int number = static_cast<int>(i);
      const bool is_alike = IsDerivedAlike(i < before.size() ? &before[i] : nullptr, layer.Record(geoid));
      const auto parent_page = [&](Quadcode node) {
        if (gone_.contains({layer.parent, node.word()})) return std::optional<std::vector<uint8_t>>();
        auto put = writer.WasPut(layer.parent, node) ? writer.Get(layer.parent, node) : std::nullopt;
        return put ? put : unchanged.Page(layer.parent, node);
      };
      const auto is_known = [&](Quadcode node) {
        if (!is_alike || !unchanged.Exists(number, node) || writer.WasPut(layer.parent, node)) return false;
        unchanged.Take(number, node);
        return true;
      };
      const DerivedWork work{number, jobs_, options_.batch_bytes, parent_page, is_known};
      const LayerSpec& parent = layers_[static_cast<size_t>(layer.parent)].spec;
      Status status = MakeDerivedLayer(layer.spec, parent, work, geoid, writer);
      if (status.ok()) status = RemoveGone(number, unchanged, writer);
      if (!status.ok()) return status;
    }
    return {};
  }

  // Sources that the layer did not have, or not so.
  void FindChanged(size_t layer, const LayerRecord* before) {
    for (const auto& source : layers_[layer].sources) {
      const SourceRecord record = source->Record();
      const bool was_there = before != nullptr && Has(before->sources, record);
      if (!was_there) changed_.push_back(source.get());
    }
  }

  Status MakePages(const Geoid& geoid, UnchangedPages& unchanged, ChangeWriter& writer) {
    PageSink sink(writer, options_.batch_bytes, [] { return std::string(); });
    int64_t planned = 0;
    for (const OpenLayer& layer : layers_) planned += IsOfRasters(layer.spec) ? CountNodes(layer.plan) : 0;
    std::optional<Progress> progress;
    if (options_.show_progress)
      progress.emplace(planned, clock_, [&sink] { return Progress::Written{sink.pages(), sink.bytes()}; });
    std::vector<std::unique_ptr<LayerBuilder>> builders;
    for (size_t i = 0; i < layers_.size(); ++i) {
      if (!IsOfRasters(layers_[i].spec)) continue;
      builders.push_back(std::make_unique<LayerBuilder>(static_cast<int>(i), layers_[i], geoid, sink, &unchanged,
                                                        progress ? &*progress : nullptr));
    }
    BuildAllTrees(builders, jobs_);
    const Status written = sink.Close();
    for (const OpenLayer& layer : layers_) {
      for (const auto& source : layer.sources) {
        if (!source->failure().ok()) return Refusal(source->spec(), source->failure().message());
      }
    }
    for (const OpenLayer& layer : layers_) {
      for (const Unmatched& unmatched : layer.unmatched) Warn(NameOf(unmatched.source->spec()), unmatched.reason);
    }
    if (!written.ok()) return written;
    Status checked = CheckChanged();
    for (size_t i = 0; checked.ok() && i < layers_.size(); ++i) {
      if (IsOfRasters(layers_[i].spec)) checked = RemoveGone(static_cast<int>(i), unchanged, writer);
    }
    if (checked.ok()) checked = MakeVectors(unchanged, writer);
    return checked.ok() ? MakeDerived(geoid, unchanged, writer) : checked;
  }

  Status CheckChanged() {
    for (RasterSource* source : changed_) {
      const std::string path = NameOf(source->spec());
      if (!source->used() && !source->HasData())
        return Refusal(source->spec(), "it covers nothing: no pixel is valid; check its nodata and mask");
      if (!source->remark().empty()) Warn(path, source->remark());
      if (!source->used()) Warn(path, "nothing of it is seen: later sources cover it all");
    }
    return {};
  }

  void Warn(const std::string& path, const std::string& reason) {
    report_.warnings.push_back({path, reason});
    LogWarning("{}: {}", path, reason);
  }

  // Pages that were there and are none of what the layer is made of now.
  Status RemoveGone(int layer, const UnchangedPages& unchanged, ChangeWriter& writer) {
    if (static_cast<size_t>(layer) >= writer.before().layers().size()) return {};
    for (int tree = 0; tree < kTrees; ++tree) {
      if (Status status = RemoveGoneFrom(unchanged, layer, Quadcode::Root(tree), writer); !status.ok()) return status;
    }
    return {};
  }

  Status RemoveGoneFrom(const UnchangedPages& unchanged, int layer, Quadcode node, ChangeWriter& writer) {
    if (!unchanged.Exists(layer, node) || unchanged.IsTaken(layer, node)) return {};
    if (!writer.WasPut(layer, node)) {
      if (Status status = writer.Remove(layer, node); !status.ok()) return status;
      gone_.insert({layer, node.word()});
    }
    if (node.level() == kMaxLevel) return {};
    for (const int which : node.Children()) {
      if (Status status = RemoveGoneFrom(unchanged, layer, node.Child(which), writer); !status.ok()) return status;
    }
    return {};
  }

  Status Describe() {
    const auto dataset = Dataset::Open(options_.out);
    if (!dataset.ok()) return dataset.status();
    report_.layers = (*dataset)->layers();
    report_.bytes = (*dataset)->bytes();
    for (const LayerRecord& layer : report_.layers) report_.pages += layer.pages;
    for (const OpenLayer& layer : layers_) {
      for (const auto& source : layer.sources) report_.bytes_read += source->bytes_read();
    }
    return {};
  }

  const BuildOptions& options_;
  const Clock& clock_;
  const int jobs_;
  BlockCache cache_;
  std::vector<OpenLayer> layers_;  // go before the cache
  std::vector<RasterSource*> changed_;
  bool vectors_change_ = false;              // any layer's sources
  std::set<std::pair<int, uint64_t>> gone_;  // layers and quadcode words of pages that were there
  BuildReport report_;
};

}  // namespace

Result<BuildReport> Update(const SpecChange& change, const BuildOptions& options, const Clock& clock) {
  try {
    return Updater(options, clock).Run(change);
  } catch (const std::exception& problem) {
    return Status::Error("{}: the change broke off: {}; it is as it was", options.out, problem.what());
  }
}

}  // namespace belvedere

// LiveDataset: a dataset that may be changed or built anew while it is read: it answers from the one that it was last
// given, in place of the one before, without a pause.
//
// Its layers are those it started with, by number, name, kind and meaning; all may be as deep as layers can be. What is
// opened next has to have them too, and may have more, which stay unknown here.
//
// Threads: any; Switch by one at a time. What a span of Nodes names stays until the next Switch.
#pragma once

#include "runtime/paging/dataset.h"

#include <memory>
#include <shared_mutex>
#include <string>
#include <unordered_set>
#include <vector>

namespace belvedere {

// Which pages differ between two states of a dataset.
class ChangedPages {
 public:
  // From what the stores say: the pages of changes that came since; of another store, all.
  static ChangedPages Between(const Dataset& before, const Dataset& after);

  // Whether anything that is made of the dataset's pages at this quadnode and around it may differ.
  bool MayReach(Quadcode node) const;
  bool all() const { return all_; }
  size_t count() const { return words_.size(); }

 private:
  bool all_ = false;
  std::unordered_set<uint64_t> words_;  // of quadcodes, of whichever layer
};

class LiveDataset final : public Dataset {
 public:
  static Result<std::unique_ptr<LiveDataset>> Open(const std::string& path);
  // As `like` is, reading `dataset`. For who makes pages of what is to come.
  LiveDataset(const LiveDataset& like, std::shared_ptr<const Dataset> dataset);

  // Which stores lie at the path now: another text where anything was moved there since.
  static std::string StateOnDisk(const std::string& path);

  std::shared_ptr<const Dataset> current() const;
  // Ok where the dataset has this one's layers; else what it lacks.
  Status Fits(const Dataset& next) const;
  // REQUIRES: Fits.
  void Switch(std::shared_ptr<const Dataset> next);

  const std::string& path() const override { return path_; }
  const std::vector<LayerRecord>& layers() const override { return layers_; }
  const std::string& build_time() const override { return build_time_; }  // of the first
  int version() const override { return version_; }                       // likewise
  int64_t bytes() const override { return current()->bytes(); }
  bool Exists(int layer, Quadcode node) const override;
  std::span<const uint64_t> Nodes(int layer) const override { return current()->Nodes(layer); }
  Result<std::shared_ptr<ElevationPage>> ReadElevation(int layer, Quadcode node) const override {
    return current()->ReadElevation(layer, node);
  }
  Result<std::shared_ptr<ImagePage>> ReadImage(int layer, Quadcode node) const override {
    return current()->ReadImage(layer, node);
  }
  Result<std::shared_ptr<PropertyPage>> ReadProperty(int layer, Quadcode node) const override {
    return current()->ReadProperty(layer, node);
  }
  Result<std::shared_ptr<VectorPage>> ReadVector(int layer, Quadcode node) const override {
    return current()->ReadVector(layer, node);
  }
  Result<std::shared_ptr<BuildingPage>> ReadBuildings(int layer, Quadcode node) const override {
    return current()->ReadBuildings(layer, node);
  }
  std::string features_path() const override { return current()->features_path(); }
  std::vector<std::string> store_ids() const override { return current()->store_ids(); }
  void ForEachKey(size_t store, const std::function<void(int, Quadcode)>& visit) const override {
    current()->ForEachKey(store, visit);
  }
  std::optional<std::vector<uint8_t>> ReadRaw(int layer, Quadcode node) const override {
    return current()->ReadRaw(layer, node);
  }
  std::optional<std::vector<uint8_t>> ReadDeviations(int layer, Quadcode node) const override {
    return current()->ReadDeviations(layer, node);
  }
  int64_t StoredBytes(int layer, Quadcode node) const override { return current()->StoredBytes(layer, node); }

 private:
  explicit LiveDataset(std::shared_ptr<const Dataset> first);

  const std::string path_, build_time_;
  const int version_;
  const std::vector<LayerRecord> layers_;
  mutable std::shared_mutex mutex_;  // of current_
  std::shared_ptr<const Dataset> current_;
};

}  // namespace belvedere

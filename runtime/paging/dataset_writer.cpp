#include "runtime/paging/dataset_writer.h"

#include "runtime/paging/folder_lock.h"
#include "runtime/paging/lmdb_writer.h"
#include "runtime/paging/page_counts.h"

#include <filesystem>
#include <map>
#include <random>
#include <utility>

namespace belvedere {
namespace {

class WholeWriter final : public DatasetWriter {
 public:
  explicit WholeWriter(const std::string& path) : path_(path), store_(path) {}

  Status Start(const std::string& made_of) {
    if (Status status = store_.Lock(); !status.ok()) return status;
    if (!store_.GoOn(made_of)) return store_.StartEmpty(made_of);
    List();
    return {};
  }

  Status StartFromLeft(const std::string& made_of) {
    if (Status status = store_.Lock(); !status.ok()) return status;
    store_.Leave();
    if (!store_.GoOn(made_of))
      return Status::Error("{}.partial: there is nothing to go on from, or it is of other sources", path_);
    List();
    return {};
  }

  Status Put(int layer, Quadcode node, const std::vector<uint8_t>& value) override {
    return store_.Put(store::MakeKey(layer, node.word()), value);
  }
  Status Leave() override {
    store_.Leave();
    Status status = store_.Commit();
    List();
    return status;
  }
  Status PutDeviations(int layer, Quadcode node, const std::vector<uint8_t>& value) override {
    return store_.Put(store::MakeDeviationsKey(layer, node.word()), value);
  }
  Status Note(const std::string& text) override { return store_.PutText(store::kNotesKey, text); }
  Status Commit() override { return store_.Commit(); }
  std::optional<std::vector<uint8_t>> Get(int layer, Quadcode node) override {
    return store_.Get(store::MakeKey(layer, node.word()));
  }
  std::optional<std::vector<uint8_t>> GetDeviations(int layer, Quadcode node) override {
    return store_.Get(store::MakeDeviationsKey(layer, node.word()));
  }
  std::vector<uint64_t> Resumed(int layer) override {
    const auto found = resumed_.find(layer);
    return found == resumed_.end() ? std::vector<uint64_t>() : found->second;
  }
  const std::string& notes() const override { return notes_; }

  Status Finish(std::vector<LayerRecord> layers, const std::string& build_time) override {
    for (LayerRecord& layer : layers) ClearCounts(layer);
    store_.ForEachPage([&layers](int number, Quadcode node, size_t bytes) {
      if (static_cast<size_t>(number) >= layers.size()) return;
      CountPage(layers[static_cast<size_t>(number)], node, 1, static_cast<int64_t>(bytes));
    });
    return store_.MoveIntoPlace({build_time, std::move(layers), NewStoreId(), {}, features_},
                                std::string(store::kStoreFile), 0);
  }
  std::string partial_folder() const override { return store_.partial_folder(); }
  void SetFeatures(const std::string& file) override { features_ = file; }

 private:
  void List() {
    notes_ = store_.GetText(store::kNotesKey).value_or(std::string());
    resumed_.clear();
    store_.ForEachPage([this](int layer, Quadcode node, size_t) { resumed_[layer].push_back(node.word()); });
  }

  const std::string path_;
  LmdbWriter store_;
  std::map<int, std::vector<uint64_t>> resumed_;  // by layer
  std::string notes_, features_;
};

}  // namespace

std::string NewStoreId() {
  std::random_device random;
  std::string id;
  for (int i = 0; i < 4; ++i) id += fmt::format("{:08x}", random());
  return id;
}

Result<std::unique_ptr<DatasetWriter>> DatasetWriter::Create(const std::string& path, const std::string& made_of) {
  auto writer = std::make_unique<WholeWriter>(path);
  if (Status status = writer->Start(made_of); !status.ok()) return status;
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

Result<std::unique_ptr<DatasetWriter>> DatasetWriter::TakeUp(const std::string& path, const std::string& made_of) {
  std::error_code error;
  if (!std::filesystem::exists(path + ".partial", error)) return Status::Error("{}.partial: it is not there", path);
  auto writer = std::make_unique<WholeWriter>(path);
  if (Status status = writer->StartFromLeft(made_of); !status.ok()) return status;
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

Status DatasetWriter::Discard(const std::string& path) {
  const std::string partial = path + ".partial";
  std::error_code error;
  if (!std::filesystem::exists(partial, error)) return {};
  const auto lock = FolderLock::Take(partial);
  if (!lock.ok()) return lock.status();
  std::filesystem::remove_all(partial, error);
  return error ? Status::Error("{}: cannot be removed: {}", partial, error.message()) : Status();
}

}  // namespace belvedere

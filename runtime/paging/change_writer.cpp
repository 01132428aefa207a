#include "runtime/paging/change_writer.h"

#include "runtime/paging/lmdb_writer.h"
#include "runtime/paging/page_counts.h"
#include "runtime/paging/store_stack.h"

#include <algorithm>
#include <set>
#include <utility>

namespace belvedere {
namespace {

class StackedWriter final : public ChangeWriter {
 public:
  explicit StackedWriter(const std::string& path) : path_(path), store_(path) {}

  Status Start() {
    if (auto there = StoreStack::Open(path_); !there.ok()) return there.status();  // before a folder is made
    if (Status status = store_.Lock(); !status.ok()) return status;
    auto stack = StoreStack::Open(path_);
    if (!stack.ok()) return stack.status();
    stack_ = std::move(*stack);
    auto before = Dataset::Open(path_);
    if (!before.ok()) return before.status();
    before_ = std::move(*before);
    layers_ = before_->layers();
    if (stack_->IdUnder(1).empty())
      return Status::Error("{}: it was built before datasets could be changed; build it again", path_);
    return store_.StartEmpty({});
  }

  const Dataset& before() const override { return *before_; }

  Status Put(int layer, Quadcode node, const std::vector<uint8_t>& value) override {
    BELVEDERE_CHECK(put_.insert({layer, node.word()}).second);
    if (!has_deviations_.contains({layer, node.word()})) {
      if (Status status = RemoveDeviations(layer, node); !status.ok()) return status;
    }
    const auto old = Old(layer) ? before_->ReadRaw(layer, node) : std::nullopt;
    if (old == value) return {};
    ++written_;
    CountPage(LayerOf(layer), node, old ? 0 : 1,
              static_cast<int64_t>(value.size()) - static_cast<int64_t>(old ? old->size() : 0));
    return store_.Put(store::MakeKey(layer, node.word()), value);
  }

  Status PutDeviations(int layer, Quadcode node, const std::vector<uint8_t>& value) override {
    has_deviations_.insert({layer, node.word()});
    if (Old(layer) && before_->ReadDeviations(layer, node) == value) return {};
    return store_.Put(store::MakeDeviationsKey(layer, node.word()), value);
  }

  Status Remove(int layer, Quadcode node) override {
    ++removed_;
    CountPage(LayerOf(layer), node, -1, -before_->StoredBytes(layer, node));
    if (Status status = RemoveDeviations(layer, node); !status.ok()) return status;
    return store_.Put(store::MakeKey(layer, node.word()), {});
  }

  Status Note(const std::string&) override { return {}; }
  Status Commit() override { return store_.Commit(); }
  std::optional<std::vector<uint8_t>> Get(int layer, Quadcode node) override {
    return store_.Get(store::MakeKey(layer, node.word()));
  }
  std::optional<std::vector<uint8_t>> GetDeviations(int layer, Quadcode node) override {
    return store_.Get(store::MakeDeviationsKey(layer, node.word()));
  }
  std::vector<uint64_t> Resumed(int) override { return {}; }
  Status Leave() override { return Status::Error("a change is made whole or not at all"); }
  const std::string& notes() const override { return notes_; }
  std::string partial_folder() const override { return store_.partial_folder(); }
  void SetFeatures(const std::string& file) override { features_ = file; }
  bool WasPut(int layer, Quadcode node) const override { return put_.contains({layer, node.word()}); }
  int64_t written() const override { return written_; }
  int64_t removed() const override { return removed_; }

  Status Finish(std::vector<LayerRecord> layers, const std::string& build_time) override {
    for (size_t layer = 0; layer < layers.size(); ++layer) {
      const LayerRecord& counted = LayerOf(static_cast<int>(layer));
      layers[layer].pages = counted.pages;
      layers[layer].bytes = counted.bytes;
      layers[layer].max_level = counted.max_level;
      layers[layer].pages_per_level = counted.pages_per_level;
    }
    int number = stack_->changes() + 1;
    if (number > StoreStack::kMostChanges) {
      if (Status status = TakeInChanges(); !status.ok()) return status;
      number = 1;
    }
    return store_.MoveIntoPlace({build_time, std::move(layers), NewStoreId(), stack_->IdUnder(number), features_},
                                store::ChangeFile(number), number);
  }

 private:
  bool Old(int layer) const { return static_cast<size_t>(layer) < before_->layers().size(); }

  Status RemoveDeviations(int layer, Quadcode node) {
    if (!Old(layer) || !before_->ReadDeviations(layer, node)) return {};
    return store_.Put(store::MakeDeviationsKey(layer, node.word()), {});
  }

  LayerRecord& LayerOf(int layer) {
    while (layers_.size() <= static_cast<size_t>(layer)) {
      layers_.emplace_back();
      ClearCounts(layers_.back());
    }
    return layers_[static_cast<size_t>(layer)];
  }

  // All that they hold and this one does not, the newest first.
  Status TakeInChanges() {
    Status status;
    for (int change = stack_->changes(); change > 0 && status.ok(); --change) {
      stack_->ForEach(change, [&](std::span<const uint8_t> key, std::span<const uint8_t> value) {
        if (status.ok()) status = store_.PutIfNew(key, value);
      });
      if (status.ok()) status = store_.Commit();
    }
    return status;
  }

  const std::string path_;
  LmdbWriter store_;
  std::unique_ptr<StoreStack> stack_;
  std::unique_ptr<Dataset> before_;
  std::vector<LayerRecord> layers_;                          // counted as they will be
  std::set<std::pair<int, uint64_t>> put_, has_deviations_;  // layers and quadcode words
  int64_t written_ = 0, removed_ = 0;
  const std::string notes_;
  std::string features_;
};

}  // namespace

Result<std::unique_ptr<ChangeWriter>> ChangeWriter::Create(const std::string& path) {
  auto writer = std::make_unique<StackedWriter>(path);
  if (Status status = writer->Start(); !status.ok()) return status;
  return std::unique_ptr<ChangeWriter>(std::move(writer));
}

}  // namespace belvedere

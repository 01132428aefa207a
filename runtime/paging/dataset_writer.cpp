#include "runtime/paging/dataset_writer.h"

#include "runtime/base/mutex.h"
#include "runtime/paging/dataset_store.h"
#include "runtime/paging/folder_lock.h"

#include <lmdb.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

namespace belvedere {
namespace {

namespace fs = std::filesystem;

// Address space, not disk: the file grows with what is written.
constexpr size_t kLargestStoreBytes = size_t{1} << 40;
constexpr size_t kLeastStoreBytes = size_t{1} << 30;

class LmdbWriter final : public DatasetWriter {
 public:
  explicit LmdbWriter(std::string path) : path_(std::move(path)), partial_(path_ + ".partial") {}
  ~LmdbWriter() override {
    Close();
    if (lock_ == nullptr || finished_) return;
    std::error_code ignored;
    fs::remove_all(partial_, ignored);
  }

  Status Start(const std::string& made_of) {
    auto lock = FolderLock::Take(partial_);
    if (!lock.ok()) return lock.status();
    lock_ = std::move(*lock);
    if (!made_of.empty() && GoOn(made_of)) return {};
    if (Status status = Empty(); !status.ok()) return status;
    int rc = OpenAndBegin();
    if (rc == MDB_SUCCESS && !made_of.empty()) rc = PutText(store::kMadeOfKey, made_of);
    return rc == MDB_SUCCESS ? Status() : Problem(rc);
  }

  Status Put(int layer, Quadcode node, const std::vector<uint8_t>& value) override {
    const MutexLock lock(mutex_);
    return PutAt(store::MakeKey(layer, node.word()), value);
  }
  Status PutDeviations(int layer, Quadcode node, const std::vector<uint8_t>& value) override {
    const MutexLock lock(mutex_);
    return PutAt(store::MakeDeviationsKey(layer, node.word()), value);
  }
  Status Note(const std::string& text) override {
    const MutexLock lock(mutex_);
    const int rc = PutText(store::kNotesKey, text);
    return rc == MDB_SUCCESS ? Status() : Problem(rc);
  }

  Status Commit() override {
    const MutexLock lock(mutex_);
    int rc = mdb_txn_commit(std::exchange(txn_, nullptr));
    if (rc == MDB_SUCCESS) rc = Begin();
    return rc == MDB_SUCCESS ? Status() : Problem(rc);
  }

  std::optional<std::vector<uint8_t>> Get(int layer, Quadcode node) override {
    const MutexLock lock(mutex_);
    return GetAt(store::MakeKey(layer, node.word()));
  }
  std::optional<std::vector<uint8_t>> GetDeviations(int layer, Quadcode node) override {
    const MutexLock lock(mutex_);
    return GetAt(store::MakeDeviationsKey(layer, node.word()));
  }
  std::vector<uint64_t> Resumed(int layer) override {
    const auto found = resumed_.find(layer);
    return found == resumed_.end() ? std::vector<uint64_t>() : found->second;
  }
  const std::string& notes() const override { return notes_; }

  Status Finish(std::vector<LayerRecord> layers, const std::string& build_time) override {
    const MutexLock lock(mutex_);
    CountPages(layers);
    int rc = Remove(store::kMadeOfKey);
    if (rc == MDB_SUCCESS) rc = Remove(store::kNotesKey);
    if (rc == MDB_SUCCESS) rc = PutText(store::kMetadataKey, store::ToJson({build_time, std::move(layers)}));
    if (rc == MDB_SUCCESS) rc = mdb_txn_commit(std::exchange(txn_, nullptr));
    if (rc == MDB_SUCCESS) rc = mdb_env_sync(env_, 1);
    if (rc != MDB_SUCCESS) return Problem(rc);
    Close();
    return MoveIntoPlace();
  }

 private:
  // Whether what an earlier writer left is of the same, and open.
  bool GoOn(const std::string& made_of) {
    std::error_code error;
    if (!fs::exists(fs::path(partial_) / store::kStoreFile, error)) return false;
    if (OpenAndBegin() == MDB_SUCCESS && GetText(store::kMadeOfKey) == made_of) {
      notes_ = GetText(store::kNotesKey).value_or(std::string());
      ForEachPage([this](int layer, Quadcode node, size_t) { resumed_[layer].push_back(node.word()); });
      return true;
    }
    Close();
    return false;
  }

  Status Empty() const {
    for (const fs::directory_entry& entry : fs::directory_iterator(partial_)) {
      std::error_code error;
      fs::remove_all(entry.path(), error);
      if (error) return Status::Error("{}: cannot be cleared: {}", partial_, error.message());
    }
    return {};
  }

  // The map is address space, not memory; where the system gives less of it (a limit, a sanitizer), less must do.
  int OpenAndBegin() {
    int rc = ENOMEM;
    for (size_t bytes = kLargestStoreBytes; rc == ENOMEM && bytes >= kLeastStoreBytes; bytes /= 4)
      rc = OpenStore(bytes);
    return rc == MDB_SUCCESS ? Begin() : rc;
  }

  int OpenStore(size_t map_bytes) {
    if (env_ != nullptr) mdb_env_close(std::exchange(env_, nullptr));
    int rc = mdb_env_create(&env_);
    if (rc == MDB_SUCCESS) rc = mdb_env_set_mapsize(env_, map_bytes);
    // Pages are synced before what refers to them is written: where the system stops, the last commit or the one
    // before it is whole.
    if (rc == MDB_SUCCESS) rc = mdb_env_open(env_, partial_.c_str(), MDB_NOLOCK | MDB_NOMETASYNC | MDB_NOTLS, 0644);
    return rc;
  }

  int Begin() {
    const int rc = mdb_txn_begin(env_, nullptr, 0, &txn_);
    return rc == MDB_SUCCESS && dbi_ == 0 ? mdb_dbi_open(txn_, nullptr, 0, &dbi_) : rc;
  }

  void Close() {
    if (txn_ != nullptr) mdb_txn_abort(std::exchange(txn_, nullptr));
    if (env_ != nullptr) mdb_env_close(std::exchange(env_, nullptr));
    dbi_ = 0;
  }

  template <typename KeyType>
  Status PutAt(KeyType bytes, const std::vector<uint8_t>& value) REQUIRES_LOCK(mutex_) {
    MDB_val key{bytes.size(), bytes.data()};
    MDB_val stored{value.size(), const_cast<uint8_t*>(value.data())};
    const int rc = mdb_put(txn_, dbi_, &key, &stored, 0);
    return rc == MDB_SUCCESS ? Status() : Problem(rc);
  }
  template <typename KeyType>
  std::optional<std::vector<uint8_t>> GetAt(KeyType bytes) REQUIRES_LOCK(mutex_) {
    MDB_val key{bytes.size(), bytes.data()};
    MDB_val value{};
    if (mdb_get(txn_, dbi_, &key, &value) != MDB_SUCCESS) return std::nullopt;
    const auto* first = static_cast<const uint8_t*>(value.mv_data);
    return std::vector<uint8_t>(first, first + value.mv_size);
  }

  static MDB_val TextKey(std::string_view name) { return {name.size(), const_cast<char*>(name.data())}; }
  int PutText(std::string_view name, const std::string& text) {
    MDB_val key = TextKey(name);
    MDB_val value{text.size(), const_cast<char*>(text.data())};
    return mdb_put(txn_, dbi_, &key, &value, 0);
  }
  std::optional<std::string> GetText(std::string_view name) {
    MDB_val key = TextKey(name);
    MDB_val value{};
    if (mdb_get(txn_, dbi_, &key, &value) != MDB_SUCCESS) return std::nullopt;
    return std::string(static_cast<const char*>(value.mv_data), value.mv_size);
  }
  int Remove(std::string_view name) {
    MDB_val key = TextKey(name);
    const int rc = mdb_del(txn_, dbi_, &key, nullptr);
    return rc == MDB_NOTFOUND ? MDB_SUCCESS : rc;
  }

  Status Problem(int rc) const {
    // LMDB reports a write that the disk took only a part of as EIO.
    if (rc == ENOSPC || rc == EFBIG || rc == EDQUOT || rc == EIO) {
      return Status::Error(
          "{}: the disk is full{} ({}); free some space and build again, what was at {} before is unchanged", partial_,
          rc == EIO ? " or failing" : "", mdb_strerror(rc), path_);
    }
    return Status::Error("{}: cannot write the dataset: {}; what was at {} before is unchanged", partial_,
                         mdb_strerror(rc), path_);
  }

  // visit(layer, node, bytes as stored), in the order of the keys.
  template <typename Visit>
  void ForEachPage(const Visit& visit) {
    MDB_cursor* cursor = nullptr;
    if (mdb_cursor_open(txn_, dbi_, &cursor) != MDB_SUCCESS) return;
    MDB_val key{};
    MDB_val value{};
    while (mdb_cursor_get(cursor, &key, &value, MDB_NEXT) == MDB_SUCCESS) {
      if (key.mv_size != store::kKeyBytes) continue;
      const auto* bytes = static_cast<const uint8_t*>(key.mv_data);
      if (const auto node = Quadcode::FromWord(store::WordOfKey(bytes))) visit(int{bytes[0]}, *node, value.mv_size);
    }
    mdb_cursor_close(cursor);
  }

  void CountPages(std::vector<LayerRecord>& layers) {
    for (auto& layer : layers) {
      layer.pages = layer.bytes = 0;
      layer.max_level = 0;
      layer.pages_per_level.assign(1, 0);
    }
    ForEachPage([&layers](int number, Quadcode node, size_t bytes) {
      if (static_cast<size_t>(number) >= layers.size()) return;
      LayerRecord& layer = layers[static_cast<size_t>(number)];
      const auto level = static_cast<size_t>(node.level());
      layer.max_level = std::max(layer.max_level, node.level());
      if (layer.pages_per_level.size() <= level) layer.pages_per_level.resize(level + 1);
      ++layer.pages_per_level[level];
      ++layer.pages;
      layer.bytes += static_cast<int64_t>(bytes);
    });
  }

  // The one file of the store is renamed, which is atomic, so that there is a whole dataset at every moment.
  Status MoveIntoPlace() {
    std::error_code error;
    fs::create_directories(path_, error);
    if (!error) fs::rename(fs::path(partial_) / store::kStoreFile, fs::path(path_) / store::kStoreFile, error);
    if (error) return Status::Error("{}: cannot move the new dataset into place: {}", path_, error.message());
    fs::remove_all(partial_, error);
    finished_ = true;
    return {};
  }

  const std::string path_;
  const std::string partial_;
  std::unique_ptr<FolderLock> lock_;
  std::map<int, std::vector<uint64_t>> resumed_;  // by layer
  std::string notes_;
  Mutex mutex_;  // of the transaction
  MDB_env* env_ = nullptr;
  MDB_txn* txn_ = nullptr;
  MDB_dbi dbi_ = 0;
  bool finished_ = false;
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> DatasetWriter::Create(const std::string& path, const std::string& made_of) {
  auto writer = std::make_unique<LmdbWriter>(path);
  if (Status status = writer->Start(made_of); !status.ok()) return status;
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

Status DatasetWriter::Discard(const std::string& path) {
  const std::string partial = path + ".partial";
  std::error_code error;
  if (!fs::exists(partial, error)) return {};
  const auto lock = FolderLock::Take(partial);
  if (!lock.ok()) return lock.status();
  fs::remove_all(partial, error);
  return error ? Status::Error("{}: cannot be removed: {}", partial, error.message()) : Status();
}

}  // namespace belvedere

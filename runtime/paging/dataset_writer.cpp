#include "runtime/paging/dataset_writer.h"

#include "runtime/paging/dataset_store.h"

#include <lmdb.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
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
    if (!finished_) {
      std::error_code ignored;
      fs::remove_all(partial_, ignored);
    }
  }

  Status Start() {
    std::error_code error;
    fs::remove_all(partial_, error);
    fs::create_directories(partial_, error);
    if (error) return Status::Error("{}: cannot make the folder: {}", partial_, error.message());
    // The map is address space, not memory; where the system gives less of it (a limit, a sanitizer), less must do.
    int rc = ENOMEM;
    for (size_t bytes = kLargestStoreBytes; rc == ENOMEM && bytes >= kLeastStoreBytes; bytes /= 4)
      rc = OpenStore(bytes);
    if (rc == MDB_SUCCESS) rc = Begin();
    return rc == MDB_SUCCESS ? Status() : Problem(rc);
  }

  Status Put(int layer, Quadcode node, const std::vector<uint8_t>& value) override {
    store::Key bytes = store::MakeKey(layer, node.word());
    MDB_val key{bytes.size(), bytes.data()};
    MDB_val stored{value.size(), const_cast<uint8_t*>(value.data())};
    if (const int rc = mdb_put(txn_, dbi_, &key, &stored, 0); rc != MDB_SUCCESS) return Problem(rc);
    return {};
  }

  Status Commit() override {
    int rc = mdb_txn_commit(std::exchange(txn_, nullptr));
    if (rc == MDB_SUCCESS) rc = Begin();
    return rc == MDB_SUCCESS ? Status() : Problem(rc);
  }

  std::optional<std::vector<uint8_t>> Get(int layer, Quadcode node) override {
    store::Key bytes = store::MakeKey(layer, node.word());
    MDB_val key{bytes.size(), bytes.data()};
    MDB_val value{};
    if (mdb_get(txn_, dbi_, &key, &value) != MDB_SUCCESS) return std::nullopt;
    const auto* first = static_cast<const uint8_t*>(value.mv_data);
    return std::vector<uint8_t>(first, first + value.mv_size);
  }

  Status Finish(std::vector<LayerRecord> layers, const std::string& build_time) override {
    CountPages(layers);
    const std::string json = store::ToJson({build_time, std::move(layers)});
    MDB_val key{store::kMetadataKey.size(), const_cast<char*>(store::kMetadataKey.data())};
    MDB_val value{json.size(), const_cast<char*>(json.data())};
    int rc = mdb_put(txn_, dbi_, &key, &value, 0);
    if (rc == MDB_SUCCESS) rc = mdb_txn_commit(std::exchange(txn_, nullptr));
    if (rc == MDB_SUCCESS) rc = mdb_env_sync(env_, 1);
    if (rc != MDB_SUCCESS) return Problem(rc);
    Close();
    return MoveIntoPlace();
  }

 private:
  int OpenStore(size_t map_bytes) {
    if (env_ != nullptr) mdb_env_close(std::exchange(env_, nullptr));
    int rc = mdb_env_create(&env_);
    if (rc == MDB_SUCCESS) rc = mdb_env_set_mapsize(env_, map_bytes);
    if (rc == MDB_SUCCESS) rc = mdb_env_open(env_, partial_.c_str(), MDB_NOLOCK | MDB_NOSYNC | MDB_NOTLS, 0644);
    return rc;
  }

  int Begin() {
    const int rc = mdb_txn_begin(env_, nullptr, 0, &txn_);
    return rc == MDB_SUCCESS && dbi_ == 0 ? mdb_dbi_open(txn_, nullptr, 0, &dbi_) : rc;
  }

  void Close() {
    if (txn_ != nullptr) mdb_txn_abort(std::exchange(txn_, nullptr));
    if (env_ != nullptr) mdb_env_close(std::exchange(env_, nullptr));
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

  void CountPages(std::vector<LayerRecord>& layers) {
    for (auto& layer : layers) {
      layer.pages = layer.bytes = 0;
      layer.max_level = 0;
      layer.pages_per_level.assign(1, 0);
    }
    MDB_cursor* cursor = nullptr;
    if (mdb_cursor_open(txn_, dbi_, &cursor) != MDB_SUCCESS) return;
    MDB_val key{};
    MDB_val value{};
    while (mdb_cursor_get(cursor, &key, &value, MDB_NEXT) == MDB_SUCCESS) {
      const auto* bytes = static_cast<const uint8_t*>(key.mv_data);
      if (key.mv_size != store::kKeyBytes || bytes[0] >= layers.size()) continue;
      LayerRecord& layer = layers[bytes[0]];
      const auto node = Quadcode::FromWord(store::WordOfKey(bytes));
      const int level = node ? node->level() : 0;
      layer.max_level = std::max(layer.max_level, level);
      if (layer.pages_per_level.size() <= static_cast<size_t>(level))
        layer.pages_per_level.resize(static_cast<size_t>(level) + 1);
      ++layer.pages_per_level[static_cast<size_t>(level)];
      ++layer.pages;
      layer.bytes += static_cast<int64_t>(value.mv_size);
    }
    mdb_cursor_close(cursor);
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
  MDB_env* env_ = nullptr;
  MDB_txn* txn_ = nullptr;
  MDB_dbi dbi_ = 0;
  bool finished_ = false;
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> DatasetWriter::Create(const std::string& path) {
  auto writer = std::make_unique<LmdbWriter>(path);
  if (Status status = writer->Start(); !status.ok()) return status;
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

}  // namespace belvedere

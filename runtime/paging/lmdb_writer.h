// LmdbWriter: how DatasetWriter and ChangeWriter make a store: in a folder beside the dataset, moved into it as one
// file when it is whole.
//
// Threads: as DatasetWriter has them.
#pragma once

#include "runtime/base/mutex.h"
#include "runtime/paging/dataset_store.h"
#include "runtime/paging/dataset_writer.h"
#include "runtime/paging/folder_lock.h"
#include "runtime/paging/store_mapping.h"

#include <lmdb.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

class LmdbWriter {
 public:
  explicit LmdbWriter(const std::string& path) : path_(path), partial_(path + ".partial") {}
  ~LmdbWriter();  // unless it is moved into place or left, removes the partial store
  LmdbWriter(const LmdbWriter&) = delete;
  LmdbWriter& operator=(const LmdbWriter&) = delete;

  // Takes the lock. Nothing else before it has been.
  Status Lock();
  // Goes on with the store that an earlier writer left, if it was made of the same, which is not empty.
  bool GoOn(const std::string& made_of);
  Status StartEmpty(const std::string& made_of);
  // From here on the partial store stays when the writer goes.
  void Leave() { stays_ = true; }
  const std::string& partial_folder() const { return partial_; }

  Status Put(std::span<const uint8_t> key, std::span<const uint8_t> value) EXCLUDES_LOCK(mutex_);
  // Leaves what is there as it is.
  Status PutIfNew(std::span<const uint8_t> key, std::span<const uint8_t> value) EXCLUDES_LOCK(mutex_);
  Status PutText(std::string_view key, const std::string& text) EXCLUDES_LOCK(mutex_);
  Status RemoveText(std::string_view key) EXCLUDES_LOCK(mutex_);
  std::optional<std::vector<uint8_t>> Get(std::span<const uint8_t> key) EXCLUDES_LOCK(mutex_);
  std::optional<std::string> GetText(std::string_view key) EXCLUDES_LOCK(mutex_);
  Status Commit() EXCLUDES_LOCK(mutex_);
  // visit(layer, node, bytes as stored), in the order of the keys.
  void ForEachPage(const std::function<void(int, Quadcode, size_t)>& visit) EXCLUDES_LOCK(mutex_);

  // Writes the metadata, syncs, moves the features' file if it is new, then the store to `file` in the dataset's
  // folder, which is atomic, and removes changes there by a number over `last_change`, and features of others.
  Status MoveIntoPlace(const store::Metadata& metadata, const std::string& file, int last_change) EXCLUDES_LOCK(mutex_);

 private:
  int OpenAndBegin();
  int OpenStore(size_t map_bytes);
  int Begin();
  void Close();
  Status PutWith(std::span<const uint8_t> key, std::span<const uint8_t> value, unsigned flags) EXCLUDES_LOCK(mutex_);
  Status Problem(int rc) const;
  void GiveBackMapping() REQUIRES_LOCK(mutex_);
  void RemoveOtherFeatures(const std::string& kept) const;

  const std::string path_, partial_;
  std::unique_ptr<FolderLock> lock_;
  bool stays_ = false;
  Mutex mutex_;  // of the transaction
  MDB_env* env_ = nullptr;
  MDB_txn* txn_ = nullptr;
  MDB_dbi dbi_ = 0;
  StoreMapping mapping_;
};

}  // namespace belvedere

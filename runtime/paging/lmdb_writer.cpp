#include "runtime/paging/lmdb_writer.h"

#include <cerrno>
#include <filesystem>
#include <utility>

namespace belvedere {
namespace {

namespace fs = std::filesystem;

// Address space, not disk: the file grows with what is written.
constexpr size_t kLargestStoreBytes = size_t{1} << 40;
constexpr size_t kLeastStoreBytes = size_t{1} << 30;

MDB_val ValueOf(std::span<const uint8_t> bytes) {
  return {bytes.size(), const_cast<uint8_t*>(bytes.data())};
}
std::span<const uint8_t> BytesOf(std::string_view text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

}  // namespace

LmdbWriter::~LmdbWriter() {
  Close();
  if (lock_ == nullptr || stays_) return;
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
}

Status LmdbWriter::Lock() {
  auto lock = FolderLock::Take(partial_);
  if (!lock.ok()) return lock.status();
  lock_ = std::move(*lock);
  return {};
}

bool LmdbWriter::GoOn(const std::string& made_of) {
  std::error_code error;
  if (made_of.empty() || !fs::exists(fs::path(partial_) / store::kStoreFile, error)) return false;
  if (OpenAndBegin() == MDB_SUCCESS && GetText(store::kMadeOfKey) == made_of) return true;
  Close();
  return false;
}

Status LmdbWriter::StartEmpty(const std::string& made_of) {
  for (const fs::directory_entry& entry : fs::directory_iterator(partial_)) {
    std::error_code error;
    fs::remove_all(entry.path(), error);
    if (error) return Status::Error("{}: cannot be cleared: {}", partial_, error.message());
  }
  if (const int rc = OpenAndBegin(); rc != MDB_SUCCESS) return Problem(rc);
  return made_of.empty() ? Status() : PutText(store::kMadeOfKey, made_of);
}

// The map is address space, not memory; where the system gives less of it (a limit, a sanitizer), less must do.
int LmdbWriter::OpenAndBegin() {
  int rc = ENOMEM;
  for (size_t bytes = kLargestStoreBytes; rc == ENOMEM && bytes >= kLeastStoreBytes; bytes /= 4) rc = OpenStore(bytes);
  return rc == MDB_SUCCESS ? Begin() : rc;
}

int LmdbWriter::OpenStore(size_t map_bytes) {
  if (env_ != nullptr) mdb_env_close(std::exchange(env_, nullptr));
  int rc = mdb_env_create(&env_);
  if (rc == MDB_SUCCESS) rc = mdb_env_set_mapsize(env_, map_bytes);
  // Pages are synced before what refers to them is written: where the system stops, the last commit or the one before
  // it is whole.
  if (rc == MDB_SUCCESS) rc = mdb_env_open(env_, partial_.c_str(), MDB_NOLOCK | MDB_NOMETASYNC | MDB_NOTLS, 0644);
  return rc;
}

int LmdbWriter::Begin() {
  const int rc = mdb_txn_begin(env_, nullptr, 0, &txn_);
  return rc == MDB_SUCCESS && dbi_ == 0 ? mdb_dbi_open(txn_, nullptr, 0, &dbi_) : rc;
}

void LmdbWriter::Close() {
  if (txn_ != nullptr) mdb_txn_abort(std::exchange(txn_, nullptr));
  if (env_ != nullptr) mdb_env_close(std::exchange(env_, nullptr));
  dbi_ = 0;
  mapping_.Forget();
}

Status LmdbWriter::PutWith(std::span<const uint8_t> key, std::span<const uint8_t> value, unsigned flags) {
  const MutexLock lock(mutex_);
  MDB_val at = ValueOf(key), stored = ValueOf(value);
  const int rc = mdb_put(txn_, dbi_, &at, &stored, flags);
  return rc == MDB_SUCCESS || rc == MDB_KEYEXIST ? Status() : Problem(rc);
}

Status LmdbWriter::Put(std::span<const uint8_t> key, std::span<const uint8_t> value) {
  return PutWith(key, value, 0);
}

Status LmdbWriter::PutIfNew(std::span<const uint8_t> key, std::span<const uint8_t> value) {
  return PutWith(key, value, MDB_NOOVERWRITE);
}

Status LmdbWriter::PutText(std::string_view key, const std::string& text) {
  return Put(BytesOf(key), BytesOf(text));
}

Status LmdbWriter::RemoveText(std::string_view key) {
  const MutexLock lock(mutex_);
  MDB_val at = ValueOf(BytesOf(key));
  const int rc = mdb_del(txn_, dbi_, &at, nullptr);
  return rc == MDB_SUCCESS || rc == MDB_NOTFOUND ? Status() : Problem(rc);
}

std::optional<std::vector<uint8_t>> LmdbWriter::Get(std::span<const uint8_t> key) {
  const MutexLock lock(mutex_);
  MDB_val at = ValueOf(key), value{};
  if (mdb_get(txn_, dbi_, &at, &value) != MDB_SUCCESS) return std::nullopt;
  const auto* first = static_cast<const uint8_t*>(value.mv_data);
  return std::vector<uint8_t>(first, first + value.mv_size);
}

std::optional<std::string> LmdbWriter::GetText(std::string_view key) {
  const auto bytes = Get(BytesOf(key));
  if (!bytes) return std::nullopt;
  return std::string(bytes->begin(), bytes->end());
}

Status LmdbWriter::Commit() {
  const MutexLock lock(mutex_);
  int rc = mdb_txn_commit(std::exchange(txn_, nullptr));
  if (rc == MDB_SUCCESS) rc = Begin();
  if (rc == MDB_SUCCESS) GiveBackMapping();
  return rc == MDB_SUCCESS ? Status() : Problem(rc);
}

// What was committed lies in the mapping alone, which would grow with the store.
void LmdbWriter::GiveBackMapping() {
  MDB_cursor* cursor = nullptr;
  if (!mapping_.is_found() && mdb_cursor_open(txn_, dbi_, &cursor) == MDB_SUCCESS) {
    MDB_val key{}, value{};
    if (mdb_cursor_get(cursor, &key, &value, MDB_FIRST) == MDB_SUCCESS) mapping_.Find(key.mv_data);
    mdb_cursor_close(cursor);
  }
  mapping_.GiveBack();
}

void LmdbWriter::ForEachPage(const std::function<void(int, Quadcode, size_t)>& visit) {
  const MutexLock lock(mutex_);
  MDB_cursor* cursor = nullptr;
  if (mdb_cursor_open(txn_, dbi_, &cursor) != MDB_SUCCESS) return;
  MDB_val key{}, value{};
  while (mdb_cursor_get(cursor, &key, &value, MDB_NEXT) == MDB_SUCCESS) {
    if (key.mv_size != store::kKeyBytes) continue;
    const auto* bytes = static_cast<const uint8_t*>(key.mv_data);
    if (const auto node = Quadcode::FromWord(store::WordOfKey(bytes))) visit(int{bytes[0]}, *node, value.mv_size);
    mapping_.HaveRead(StoreMapping::kMappedAtOnce);
  }
  mdb_cursor_close(cursor);
}

Status LmdbWriter::MoveIntoPlace(const store::Metadata& metadata, const std::string& file, int last_change) {
  for (const std::string_view key : {store::kMadeOfKey, store::kNotesKey}) {
    if (Status status = RemoveText(key); !status.ok()) return status;
  }
  if (Status status = PutText(store::kMetadataKey, store::ToJson(metadata)); !status.ok()) return status;
  const MutexLock lock(mutex_);
  int rc = mdb_txn_commit(std::exchange(txn_, nullptr));
  if (rc == MDB_SUCCESS) rc = mdb_env_sync(env_, 1);
  if (rc != MDB_SUCCESS) return Problem(rc);
  Close();
  std::error_code error;
  fs::create_directories(path_, error);
  const fs::path features = fs::path(partial_) / metadata.features;
  if (!error && !metadata.features.empty() && fs::exists(features))
    fs::rename(features, fs::path(path_) / metadata.features, error);
  if (!error) fs::rename(fs::path(partial_) / store::kStoreFile, fs::path(path_) / file, error);
  if (error) return Status::Error("{}: cannot move the new dataset into place: {}", path_, error.message());
  stays_ = true;
  // They lie over what is no longer there, so that nobody looks at them any more.
  for (int number = last_change + 1; fs::remove(fs::path(path_) / store::ChangeFile(number), error); ++number) {
  }
  RemoveOtherFeatures(metadata.features);
  fs::remove_all(partial_, error);
  return {};
}

void LmdbWriter::RemoveOtherFeatures(const std::string& kept) const {
  std::error_code error;
  std::vector<fs::path> others;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool is_ours = name.starts_with(store::kFeaturesPrefix) && name.ends_with(store::kFeaturesSuffix);
    if (is_ours && name != kept) others.push_back(entry->path());
  }
  for (const fs::path& other : others) fs::remove(other, error);
}

Status LmdbWriter::Problem(int rc) const {
  // LMDB reports a write that the disk took only a part of as EIO.
  if (rc == ENOSPC || rc == EFBIG || rc == EDQUOT || rc == EIO) {
    return Status::Error(
        "{}: the disk is full{} ({}); free some space and build again, what was at {} before is unchanged", partial_,
        rc == EIO ? " or failing" : "", mdb_strerror(rc), path_);
  }
  return Status::Error("{}: cannot write the dataset: {}; what was at {} before is unchanged", partial_,
                       mdb_strerror(rc), path_);
}

}  // namespace belvedere

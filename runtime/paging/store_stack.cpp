#include "runtime/paging/store_stack.h"

#include "runtime/paging/store_mapping.h"

#include <lmdb.h>
#include <sys/stat.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace belvedere {
namespace {

// A read transaction for one call.
class ReadTransaction {
 public:
  explicit ReadTransaction(MDB_env* env) {
    if (mdb_txn_begin(env, nullptr, MDB_RDONLY, &txn_) != MDB_SUCCESS) txn_ = nullptr;
  }
  ~ReadTransaction() {
    if (txn_ != nullptr) mdb_txn_abort(txn_);
  }
  ReadTransaction(const ReadTransaction&) = delete;
  ReadTransaction& operator=(const ReadTransaction&) = delete;
  MDB_txn* get() const { return txn_; }

 private:
  MDB_txn* txn_ = nullptr;
};

std::span<const uint8_t> BytesOf(const MDB_val& value) {
  return {static_cast<const uint8_t*>(value.mv_data), value.mv_size};
}

// What a list of pages becomes under a change: its keys, in their order, with whether they are there.
std::vector<uint64_t> Changed(const std::vector<uint64_t>& words,
                              const std::vector<std::pair<uint64_t, bool>>& change) {
  std::vector<uint64_t> out;
  out.reserve(words.size() + change.size());
  auto word = words.begin();
  for (const auto& [changed, is_there] : change) {
    while (word != words.end() && *word < changed) out.push_back(*word++);
    if (word != words.end() && *word == changed) ++word;
    if (is_there) out.push_back(changed);
  }
  std::copy(word, words.end(), std::back_inserter(out));
  return out;
}

}  // namespace

class StoreStack::File {
 public:
  ~File() {
    if (env_ != nullptr) mdb_env_close(env_);
  }

  // folder: for messages.
  Status Load(const std::string& folder, const std::string& file) {
    path_ = file;
    struct stat found {};
    if (stat(file.c_str(), &found) != 0) {
      return Status::Error("{}: no dataset here (there is no {} in it); make one with belvedere-build", folder,
                           store::kStoreFile);
    }
    inode_ = found.st_ino;
    bytes_ = found.st_size;
    if (const int rc = OpenStore(file); rc != MDB_SUCCESS) {
      return Status::Error("{}: cannot open the dataset's store: {}; build it again", folder, mdb_strerror(rc));
    }
    // Pages past the end of the file must not be touched: the system would end the program.
    MDB_envinfo store_state{};
    MDB_stat store_shape{};
    mdb_env_info(env_, &store_state);
    mdb_env_stat(env_, &store_shape);
    if ((store_state.me_last_pgno + 1) * store_shape.ms_psize > static_cast<size_t>(bytes_)) {
      return Status::Error("{}: the dataset's store is cut short at {} bytes; build it again", folder, bytes_);
    }
    return LoadMetadata(folder);
  }

  const store::Metadata& metadata() const { return metadata_; }
  int64_t bytes() const { return bytes_; }
  // Nothing has been moved over it since.
  bool IsInPlace() const {
    struct stat found {};
    return stat(path_.c_str(), &found) == 0 && found.st_ino == inode_;
  }

  enum class Found { kNothing, kGone, kValue };
  Found Read(std::span<const uint8_t> bytes, const std::function<void(std::span<const uint8_t>)>& read) const {
    const ReadTransaction txn(env_);
    if (txn.get() == nullptr) return Found::kNothing;
    MDB_val key{bytes.size(), const_cast<uint8_t*>(bytes.data())};
    MDB_val value{};
    if (mdb_get(txn.get(), dbi_, &key, &value) != MDB_SUCCESS) return Found::kNothing;
    if (value.mv_size == 0) return Found::kGone;
    read(BytesOf(value));
    mapping_.HaveRead(value.mv_size);
    return Found::kValue;
  }

  // visit(key, value), whatever the keys are.
  template <typename Visit>
  int ForEach(const Visit& visit) const {
    const ReadTransaction txn(env_);
    MDB_cursor* cursor = nullptr;
    if (txn.get() == nullptr) return ENOMEM;
    if (const int rc = mdb_cursor_open(txn.get(), dbi_, &cursor); rc != MDB_SUCCESS) return rc;
    MDB_val key{}, value{};
    int rc = MDB_SUCCESS;
    while ((rc = mdb_cursor_get(cursor, &key, &value, MDB_NEXT)) == MDB_SUCCESS) {
      visit(BytesOf(key), BytesOf(value));
      mapping_.HaveRead(StoreMapping::kMappedAtOnce);
    }
    mdb_cursor_close(cursor);
    return rc == MDB_NOTFOUND ? MDB_SUCCESS : rc;
  }

 private:
  int OpenStore(const std::string& file) {
    if (const int rc = mdb_env_create(&env_); rc != MDB_SUCCESS) return rc;
    // The map is made as large as the file, not as the writer's.
    mdb_env_set_mapsize(env_, static_cast<size_t>(bytes_));
    constexpr unsigned kFlags = MDB_RDONLY | MDB_NOLOCK | MDB_NOTLS | MDB_NOSUBDIR;
    if (const int rc = mdb_env_open(env_, file.c_str(), kFlags, 0444); rc != MDB_SUCCESS) return rc;
    const ReadTransaction txn(env_);
    return txn.get() == nullptr ? ENOMEM : mdb_dbi_open(txn.get(), nullptr, 0, &dbi_);
  }

  Status LoadMetadata(const std::string& folder) {
    const ReadTransaction txn(env_);
    MDB_val key{store::kMetadataKey.size(), const_cast<char*>(store::kMetadataKey.data())};
    MDB_val value{};
    if (mdb_get(txn.get(), dbi_, &key, &value) != MDB_SUCCESS) {
      return Status::Error("{}: the store has no metadata, so it is no dataset; build it again", folder);
    }
    auto metadata = store::FromJson({static_cast<const char*>(value.mv_data), value.mv_size});
    if (!metadata.ok()) return Status::Error("{}: {}", folder, metadata.message());
    metadata_ = std::move(*metadata);
    mapping_.Find(value.mv_data);
    return {};
  }

  std::string path_;
  int64_t bytes_ = 0;
  ino_t inode_ = 0;
  MDB_env* env_ = nullptr;
  MDB_dbi dbi_ = 0;
  StoreMapping mapping_;
  store::Metadata metadata_;
};

StoreStack::StoreStack() = default;
StoreStack::~StoreStack() = default;

Result<std::unique_ptr<StoreStack>> StoreStack::Open(const std::string& folder) {
  std::unique_ptr<StoreStack> stack(new StoreStack());
  for (;;) {
    stack->files_.clear();
    Status status = stack->OpenFiles(folder);
    // Where a store is moved over one of these meanwhile, those above it are removed: what was found was half of each.
    const bool whole =
        std::all_of(stack->files_.begin(), stack->files_.end(), [](const auto& file) { return file->IsInPlace(); });
    if (!whole) continue;
    if (!status.ok()) return status;
    return stack;
  }
}

Status StoreStack::OpenFiles(const std::string& folder) {
  auto lowest = std::make_unique<File>();
  if (Status status = lowest->Load(folder, folder + "/" + std::string(store::kStoreFile)); !status.ok()) return status;
  files_.push_back(std::move(lowest));
  for (int number = 1; number <= kMostChanges; ++number) {
    const std::string name = folder + "/" + store::ChangeFile(number);
    struct stat found {};
    if (stat(name.c_str(), &found) != 0) break;
    auto change = std::make_unique<File>();
    if (Status status = change->Load(folder, name); !status.ok()) return status;
    if (change->metadata().over.empty() || change->metadata().over != IdUnder(number)) break;
    files_.push_back(std::move(change));
  }
  return {};
}

const store::Metadata& StoreStack::metadata() const {
  return files_.back()->metadata();
}

const std::string& StoreStack::IdUnder(int number) const {
  return files_[static_cast<size_t>(number) - 1]->metadata().id;
}

int64_t StoreStack::bytes() const {
  int64_t bytes = 0;
  for (const auto& file : files_) bytes += file->bytes();
  return bytes;
}

bool StoreStack::Read(std::span<const uint8_t> key, const std::function<void(std::span<const uint8_t>)>& read) const {
  for (auto file = files_.rbegin(); file != files_.rend(); ++file) {
    const File::Found found = (*file)->Read(key, read);
    if (found != File::Found::kNothing) return found == File::Found::kValue;
  }
  return false;
}

Result<std::vector<std::vector<uint64_t>>> StoreStack::ListPages() const {
  std::vector<std::vector<uint64_t>> words(metadata().layers.size());
  for (const auto& file : files_) {
    std::vector<std::vector<std::pair<uint64_t, bool>>> listed(words.size());
    const int rc = file->ForEach([&listed](std::span<const uint8_t> key, std::span<const uint8_t> value) {
      if (key.size() != store::kKeyBytes || key[0] >= listed.size()) return;
      const auto node = Quadcode::FromWord(store::WordOfKey(key.data()));
      if (node) listed[key[0]].emplace_back(node->word(), !value.empty());
    });
    if (rc != MDB_SUCCESS) return Status::Error("cannot list its pages: {}", mdb_strerror(rc));
    for (size_t layer = 0; layer < words.size(); ++layer) words[layer] = Changed(words[layer], listed[layer]);
  }
  return words;
}

void StoreStack::ForEach(int change,
                         const std::function<void(std::span<const uint8_t>, std::span<const uint8_t>)>& visit) const {
  files_[static_cast<size_t>(change)]->ForEach([&visit](std::span<const uint8_t> key, std::span<const uint8_t> value) {
    if (key.size() == store::kKeyBytes || key.size() == store::kKeyBytes + 1) visit(key, value);
  });
}

}  // namespace belvedere

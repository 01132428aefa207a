#include "runtime/paging/dataset.h"

#include "runtime/paging/dataset_store.h"
#include "runtime/paging/page_codec.h"
#include "runtime/paging/store_mapping.h"

#include <lmdb.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
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

class LmdbDataset final : public Dataset {
 public:
  explicit LmdbDataset(std::string path) : path_(std::move(path)) {}
  ~LmdbDataset() override {
    if (env_ != nullptr) mdb_env_close(env_);
  }

  Status Load() {
    const std::string file = path_ + "/" + std::string(store::kStoreFile);
    struct stat found {};
    if (stat(file.c_str(), &found) != 0) {
      return Status::Error("{}: no dataset here (there is no {} in it); make one with belvedere-build", path_,
                           store::kStoreFile);
    }
    bytes_ = found.st_size;
    if (const int rc = OpenStore(); rc != MDB_SUCCESS) {
      return Status::Error("{}: cannot open the dataset's store: {}; build it again", path_, mdb_strerror(rc));
    }
    // Pages past the end of the file must not be touched: the system would end the program.
    MDB_envinfo store_state{};
    MDB_stat store_shape{};
    mdb_env_info(env_, &store_state);
    mdb_env_stat(env_, &store_shape);
    if ((store_state.me_last_pgno + 1) * store_shape.ms_psize > static_cast<size_t>(bytes_)) {
      return Status::Error("{}: the dataset's store is cut short at {} bytes; build it again", path_, bytes_);
    }
    if (Status status = LoadMetadata(); !status.ok()) return status;
    return LoadNodes();
  }

  const std::string& path() const override { return path_; }
  const std::vector<LayerRecord>& layers() const override { return metadata_.layers; }
  const std::string& build_time() const override { return metadata_.build_time; }
  int64_t bytes() const override { return bytes_; }

  bool Exists(int layer, Quadcode node) const override {
    const auto words = Nodes(layer);
    return std::binary_search(words.begin(), words.end(), node.word());
  }
  std::span<const uint64_t> Nodes(int layer) const override { return nodes_[static_cast<size_t>(layer)]; }

  Result<std::shared_ptr<ElevationPage>> ReadElevation(int layer, Quadcode node) const override {
    return Read<ElevationPage>(layer, node, DecodeElevation);
  }
  Result<std::shared_ptr<ImagePage>> ReadImage(int layer, Quadcode node) const override {
    return Read<ImagePage>(layer, node, DecodeImage);
  }
  std::optional<std::vector<uint8_t>> ReadRaw(int layer, Quadcode node) const override {
    const ReadTransaction txn(env_);
    const auto value = Find(txn, layer, node);
    if (!value) return std::nullopt;
    return std::vector<uint8_t>(value->begin(), value->end());
  }
  std::optional<std::vector<uint8_t>> ReadDeviations(int layer, Quadcode node) const override {
    const ReadTransaction txn(env_);
    const auto value = FindAt(txn, store::MakeDeviationsKey(layer, node.word()));
    if (!value) return std::nullopt;
    return std::vector<uint8_t>(value->begin(), value->end());
  }
  int64_t StoredBytes(int layer, Quadcode node) const override {
    const ReadTransaction txn(env_);
    const auto value = Find(txn, layer, node);
    return value ? static_cast<int64_t>(value->size()) : 0;
  }

 private:
  int OpenStore() {
    if (const int rc = mdb_env_create(&env_); rc != MDB_SUCCESS) return rc;
    // The map is made as large as the file, not as the writer's.
    mdb_env_set_mapsize(env_, static_cast<size_t>(bytes_));
    if (const int rc = mdb_env_open(env_, path_.c_str(), MDB_RDONLY | MDB_NOLOCK | MDB_NOTLS, 0444);
        rc != MDB_SUCCESS) {
      return rc;
    }
    const ReadTransaction txn(env_);
    return txn.get() == nullptr ? ENOMEM : mdb_dbi_open(txn.get(), nullptr, 0, &dbi_);
  }

  Status LoadMetadata() {
    const ReadTransaction txn(env_);
    MDB_val key{store::kMetadataKey.size(), const_cast<char*>(store::kMetadataKey.data())};
    MDB_val value{};
    if (mdb_get(txn.get(), dbi_, &key, &value) != MDB_SUCCESS) {
      return Status::Error("{}: the store has no metadata, so it is no dataset; build it again", path_);
    }
    auto metadata = store::FromJson({static_cast<const char*>(value.mv_data), value.mv_size});
    if (!metadata.ok()) return Status::Error("{}: {}", path_, metadata.message());
    metadata_ = std::move(*metadata);
    mapping_.Find(value.mv_data);
    return {};
  }

  Status LoadNodes() {
    nodes_.resize(metadata_.layers.size());
    for (size_t layer = 0; layer < nodes_.size(); ++layer) {
      nodes_[layer].reserve(static_cast<size_t>(std::clamp<int64_t>(metadata_.layers[layer].pages, 0, bytes_)));
    }
    const ReadTransaction txn(env_);
    MDB_cursor* cursor = nullptr;
    if (mdb_cursor_open(txn.get(), dbi_, &cursor) != MDB_SUCCESS)
      return Status::Error("{}: cannot list its pages", path_);
    MDB_val key{};
    int rc = MDB_SUCCESS;
    while ((rc = mdb_cursor_get(cursor, &key, nullptr, MDB_NEXT)) == MDB_SUCCESS) {
      if (key.mv_size != store::kKeyBytes) continue;
      const auto* bytes = static_cast<const uint8_t*>(key.mv_data);
      const auto node = Quadcode::FromWord(store::WordOfKey(bytes));
      if (node && bytes[0] < nodes_.size()) nodes_[bytes[0]].push_back(node->word());
    }
    mdb_cursor_close(cursor);
    if (rc != MDB_NOTFOUND) return Status::Error("{}: cannot list its pages: {}", path_, mdb_strerror(rc));
    return {};
  }

  std::optional<std::span<const uint8_t>> Find(const ReadTransaction& txn, int layer, Quadcode node) const {
    return FindAt(txn, store::MakeKey(layer, node.word()));
  }
  template <typename KeyType>
  std::optional<std::span<const uint8_t>> FindAt(const ReadTransaction& txn, KeyType bytes) const {
    if (txn.get() == nullptr) return std::nullopt;
    MDB_val key{bytes.size(), bytes.data()};
    MDB_val value{};
    if (mdb_get(txn.get(), dbi_, &key, &value) != MDB_SUCCESS) return std::nullopt;
    return std::span<const uint8_t>(static_cast<const uint8_t*>(value.mv_data), value.mv_size);
  }

  template <typename PageType, typename Decode>
  Result<std::shared_ptr<PageType>> Read(int layer, Quadcode node, Decode decode) const {
    const ReadTransaction txn(env_);
    const auto value = Find(txn, layer, node);
    if (!value) return Status::Error("{}: {}", Where(layer, node), "there is no such page");
    auto page = decode(*value);
    mapping_.HaveRead(value->size());
    if (!page.ok()) return Status::Error("{}: {}; build the dataset again", Where(layer, node), page.message());
    return page;
  }

  std::string Where(int layer, Quadcode node) const {
    return fmt::format("{}: layer {}, quadnode {}", path_, layers()[static_cast<size_t>(layer)].name, node.ToString());
  }

  const std::string path_;
  int64_t bytes_ = 0;
  MDB_env* env_ = nullptr;
  MDB_dbi dbi_ = 0;
  StoreMapping mapping_;
  store::Metadata metadata_;
  std::vector<std::vector<uint64_t>> nodes_;  // by layer, ascending
};

}  // namespace

std::string_view LayerKindName(LayerKind kind) {
  return kind == LayerKind::kElevation ? "elevation" : "imagery";
}

Result<std::unique_ptr<Dataset>> Dataset::Open(const std::string& path) {
  auto dataset = std::make_unique<LmdbDataset>(path);
  if (Status status = dataset->Load(); !status.ok()) return status;
  return std::unique_ptr<Dataset>(std::move(dataset));
}

std::optional<int> Dataset::FindLayer(std::string_view name) const {
  for (size_t i = 0; i < layers().size(); ++i) {
    if (layers()[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

std::optional<int> Dataset::FindLayer(LayerKind kind) const {
  for (size_t i = 0; i < layers().size(); ++i) {
    if (layers()[i].kind == kind) return static_cast<int>(i);
  }
  return std::nullopt;
}

Quadcode Dataset::FinestContaining(int layer, double latitude_deg, double longitude_deg, int max_level) const {
  Quadcode finest = Quadcode::Containing(latitude_deg, longitude_deg, 0);
  for (int level = 1; level <= std::min(max_level, MaxLevel(layer)); ++level) {
    const Quadcode node = Quadcode::Containing(latitude_deg, longitude_deg, level);
    if (!Exists(layer, node)) break;
    finest = node;
  }
  return finest;
}

double BilinearHeight(const ElevationPage& page, Quadcode node, double latitude_deg, double longitude_deg) {
  const GeoBox box = node.Box();
  const double cells_per_degree = kCells / node.SizeDegrees();
  double east_deg = std::fmod(longitude_deg - box.west_deg, 360.0);
  if (east_deg < 0) east_deg += 360.0;
  const double x = std::clamp(east_deg * cells_per_degree, 0.0, static_cast<double>(kCells));
  const double y = std::clamp((latitude_deg - box.south_deg) * cells_per_degree, 0.0, static_cast<double>(kCells));
  const int column = std::min(static_cast<int>(x), kCells - 1);
  const int row = std::min(static_cast<int>(y), kCells - 1);
  const double fx = x - column;
  const double fy = y - row;
  const double south = page.at(column, row) * (1 - fx) + page.at(column + 1, row) * fx;
  const double north = page.at(column, row + 1) * (1 - fx) + page.at(column + 1, row + 1) * fx;
  return (south * (1 - fy) + north * fy) / 1000.0;
}

}  // namespace belvedere

#include "runtime/paging/dataset.h"

#include "runtime/paging/dataset_store.h"
#include "runtime/paging/page_codec.h"
#include "runtime/paging/store_stack.h"
#include "runtime/paging/vector_codec.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace belvedere {
namespace {

class LmdbDataset final : public Dataset {
 public:
  explicit LmdbDataset(std::string path) : path_(std::move(path)) {}

  Status Load() {
    auto stack = StoreStack::Open(path_);
    if (!stack.ok()) return stack.status();
    stack_ = std::move(*stack);
    auto nodes = stack_->ListPages();
    if (!nodes.ok()) return Status::Error("{}: {}", path_, nodes.message());
    nodes_ = std::move(*nodes);
    return {};
  }

  const std::string& path() const override { return path_; }
  const std::vector<LayerRecord>& layers() const override { return stack_->metadata().layers; }
  const std::string& build_time() const override { return stack_->metadata().build_time; }
  int version() const override { return stack_->metadata().version; }
  int64_t bytes() const override { return stack_->bytes(); }

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
  Result<std::shared_ptr<PropertyPage>> ReadProperty(int layer, Quadcode node) const override {
    return Read<PropertyPage>(layer, node, DecodeProperty);
  }
  Result<std::shared_ptr<VectorPage>> ReadVector(int layer, Quadcode node) const override {
    return Read<VectorPage>(layer, node, DecodeVector);
  }
  Result<std::shared_ptr<BuildingPage>> ReadBuildings(int layer, Quadcode node) const override {
    return Read<BuildingPage>(layer, node, DecodeBuildings);
  }
  std::vector<std::string> store_ids() const override {
    std::vector<std::string> ids;
    for (int number = 1; number <= stack_->changes() + 1; ++number) ids.push_back(stack_->IdUnder(number));
    return ids;
  }
  void ForEachKey(size_t store, const std::function<void(int, Quadcode)>& visit) const override {
    stack_->ForEach(static_cast<int>(store), [&visit](std::span<const uint8_t> key, std::span<const uint8_t>) {
      if (key.size() != store::kKeyBytes) return;
      if (const auto node = Quadcode::FromWord(store::WordOfKey(key.data()))) visit(int{key[0]}, *node);
    });
  }
  std::string features_path() const override {
    const std::string& file = stack_->metadata().features;
    return file.empty() ? file : path_ + "/" + file;
  }
  std::optional<std::vector<uint8_t>> ReadRaw(int layer, Quadcode node) const override {
    return Copy(store::MakeKey(layer, node.word()));
  }
  std::optional<std::vector<uint8_t>> ReadDeviations(int layer, Quadcode node) const override {
    return Copy(store::MakeDeviationsKey(layer, node.word()));
  }
  int64_t StoredBytes(int layer, Quadcode node) const override {
    int64_t bytes = 0;
    stack_->Read(store::MakeKey(layer, node.word()),
                 [&bytes](std::span<const uint8_t> value) { bytes = static_cast<int64_t>(value.size()); });
    return bytes;
  }

 private:
  std::optional<std::vector<uint8_t>> Copy(std::span<const uint8_t> key) const {
    std::optional<std::vector<uint8_t>> copy;
    stack_->Read(key, [&copy](std::span<const uint8_t> value) { copy.emplace(value.begin(), value.end()); });
    return copy;
  }

  template <typename PageType, typename Decode>
  Result<std::shared_ptr<PageType>> Read(int layer, Quadcode node, Decode decode) const {
    Result<std::shared_ptr<PageType>> page = Status::Error("there is no such page");
    const bool is_there =
        stack_->Read(store::MakeKey(layer, node.word()), [&](std::span<const uint8_t> value) { page = decode(value); });
    if (!is_there) return Status::Error("{}: {}", Where(layer, node), page.message());
    if (!page.ok()) return Status::Error("{}: {}; build the dataset again", Where(layer, node), page.message());
    return page;
  }

  std::string Where(int layer, Quadcode node) const {
    return fmt::format("{}: layer {}, quadnode {}", path_, layers()[static_cast<size_t>(layer)].name, node.ToString());
  }

  const std::string path_;
  std::unique_ptr<StoreStack> stack_;
  std::vector<std::vector<uint64_t>> nodes_;  // by layer, ascending
};

}  // namespace

std::string_view LayerKindName(LayerKind kind) {
  switch (kind) {
    case LayerKind::kElevation: return "elevation";
    case LayerKind::kImagery: return "imagery";
    case LayerKind::kProperty: return "property";
    case LayerKind::kVector: return "vector";
    case LayerKind::kModel: return "model";
  }
  return "";
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
  double east_deg = std::fmod(longitude_deg - box.west_deg, 360.0);
  if (east_deg < 0) east_deg += 360.0;
  const double x = std::clamp(east_deg * kCells / node.WidthDegrees(), 0.0, static_cast<double>(kCells));
  const double y =
      std::clamp((latitude_deg - box.south_deg) * kCells / node.HeightDegrees(), 0.0, static_cast<double>(kCells));
  const int column = std::min(static_cast<int>(x), kCells - 1);
  const int row = std::min(static_cast<int>(y), kCells - 1);
  const double fx = x - column;
  const double fy = y - row;
  const double south = page.at(column, row) * (1 - fx) + page.at(column + 1, row) * fx;
  const double north = page.at(column, row + 1) * (1 - fx) + page.at(column + 1, row + 1) * fx;
  return (south * (1 - fy) + north * fy) / 1000.0;
}

}  // namespace belvedere

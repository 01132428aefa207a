#include "runtime/paging/live_dataset.h"

#include "runtime/paging/dataset_store.h"
#include "runtime/paging/store_stack.h"

#include <sys/stat.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace belvedere {
namespace {

std::vector<LayerRecord> AsDeepAsCanBe(std::vector<LayerRecord> layers) {
  for (LayerRecord& layer : layers) layer.max_level = kMaxLevel;
  return layers;
}

// What the pages of the layer are shown by, besides their kind.
std::string MeaningOf(const LayerRecord& layer) {
  std::string meaning = layer.property ? store::PropertyToJson(*layer.property) : std::string();
  if (layer.step)
    meaning += fmt::format("{} {} {}", layer.step->layer, layer.step->utc_s, static_cast<int>(layer.step->repeats));
  return meaning;
}

bool IsSameLayer(const LayerRecord& a, const LayerRecord& b) {
  return a.name == b.name && a.kind == b.kind && MeaningOf(a) == MeaningOf(b);
}

}  // namespace

ChangedPages ChangedPages::Between(const Dataset& before, const Dataset& after) {
  ChangedPages changed;
  const std::vector<std::string> old = before.store_ids(), now = after.store_ids();
  changed.all_ = old.size() > now.size() || !std::equal(old.begin(), old.end(), now.begin()) || old.front().empty();
  if (changed.all_) return changed;
  for (size_t store = old.size(); store < now.size(); ++store)
    after.ForEachKey(store, [&changed](int, Quadcode node) { changed.words_.insert(node.word()); });
  return changed;
}

bool ChangedPages::MayReach(Quadcode node) const {
  if (all_) return true;
  if (words_.empty()) return false;
  for (Quadcode near : node.Around()) {
    while (!words_.contains(near.word()) && !near.is_root()) near = near.Parent();
    if (words_.contains(near.word())) return true;
  }
  return false;
}

Result<std::unique_ptr<LiveDataset>> LiveDataset::Open(const std::string& path) {
  auto first = Dataset::Open(path);
  if (!first.ok()) return first.status();
  return std::unique_ptr<LiveDataset>(new LiveDataset(std::shared_ptr<const Dataset>(std::move(*first))));
}

LiveDataset::LiveDataset(std::shared_ptr<const Dataset> first)
    : path_(first->path()),
      build_time_(first->build_time()),
      version_(first->version()),
      layers_(AsDeepAsCanBe(first->layers())),
      current_(std::move(first)) {}

LiveDataset::LiveDataset(const LiveDataset& like, std::shared_ptr<const Dataset> dataset)
    : path_(like.path_),
      build_time_(like.build_time_),
      version_(like.version_),
      layers_(like.layers_),
      current_(std::move(dataset)) {}

std::string LiveDataset::StateOnDisk(const std::string& path) {
  std::string state;
  const auto add = [&](const std::string& name) {
    struct stat found {};
    if (stat((path + "/" + name).c_str(), &found) != 0) return;
    state += fmt::format("{} {} {} {}.{:09}\n", name, found.st_ino, found.st_size, found.st_mtim.tv_sec,
                         found.st_mtim.tv_nsec);
  };
  add(std::string(store::kStoreFile));
  for (int number = 1; number <= StoreStack::kMostChanges; ++number) add(store::ChangeFile(number));
  return state;
}

std::shared_ptr<const Dataset> LiveDataset::current() const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  return current_;
}

Status LiveDataset::Fits(const Dataset& next) const {
  for (size_t i = 0; i < layers_.size(); ++i) {
    if (i < next.layers().size() && IsSameLayer(layers_[i], next.layers()[i])) continue;
    return Status::Error("{} was built anew and has no layer {} as it was in its place; start again to see it", path_,
                         layers_[i].name);
  }
  return {};
}

void LiveDataset::Switch(std::shared_ptr<const Dataset> next) {
  {
    const std::unique_lock<std::shared_mutex> lock(mutex_);
    current_.swap(next);
  }
  // The one before goes here, when nobody reads it any more.
}

bool LiveDataset::Exists(int layer, Quadcode node) const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  return current_->Exists(layer, node);
}

}  // namespace belvedere

#include "servers/dataset_follower.h"

#include "runtime/base/log.h"
#include "servers/server_thread.h"

#include <chrono>
#include <unordered_map>
#include <utility>

namespace belvedere {
namespace {

constexpr size_t kScratchBytes = size_t{64} << 20;  // of pages that others are made of

// Pages that are in use and that the change may reach, of the dataset that is to come.
std::vector<std::pair<PageKey, std::unique_ptr<const Page>>> MakeAnew(Paging& paging, const ChangedPages& changed,
                                                                      const ModuleRegistry& registry,
                                                                      const Clock& clock) {
  Paging scratch(MakeLayerTable(registry), kScratchBytes, clock);
  std::vector<std::pair<PageKey, std::unique_ptr<const Page>>> made;
  for (const PageKey& key : paging.cache.Keys(SharedCache::Which::kPinned)) {
    const bool is_model = paging.layers.at(key.type).kind == PageKind::kModel;
    if (is_model || !changed.MayReach(key.node) || !registry.at(key.type).exists(key.node)) continue;
    auto page = ReadPage(scratch, registry, key);
    if (page.ok()) made.emplace_back(key, std::move(*page));  // else whoever wishes for it finds out why
  }
  return made;
}

}  // namespace

DatasetFollower::DatasetFollower(Paging& paging, LiveDataset& dataset, const ModelCatalogue& models,
                                 const StockOptions& options, const Clock& clock, bool looks)
    : paging_(paging),
      dataset_(dataset),
      models_(models),
      options_(options),
      clock_(clock),
      state_(LiveDataset::StateOnDisk(dataset.path())) {
  if (looks) thread_ = std::thread([this] { Run(); });
}

DatasetFollower::~DatasetFollower() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  if (thread_.joinable()) thread_.join();
}

void DatasetFollower::Run() {
  BecomeServerThread("dataset");
  const auto pause = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(kPause_s));
  while (true) {
    {
      const MutexLock lock(mutex_);
      if (!stopping_) changed_.WaitFor(mutex_, pause);
      if (stopping_) return;
    }
    Look();
  }
}

bool DatasetFollower::Look() {
  std::string state = LiveDataset::StateOnDisk(dataset_.path());
  // Nothing there: a build moves the folder, or somebody has removed it. What is open can still be read.
  if (state.empty() || state == state_) return false;
  state_ = std::move(state);
  auto next = Dataset::Open(dataset_.path());
  Status status = next.status();
  if (status.ok()) status = Follow(std::shared_ptr<const Dataset>(std::move(*next)));
  if (status.ok()) return true;
  LogWarning("{}; going on with what was there", status.message());
  SetNotices({status.message()});
  return false;
}

Status DatasetFollower::Follow(const std::shared_ptr<const Dataset>& next) {
  if (Status status = dataset_.Fits(*next); !status.ok()) return status;
  const double start_s = clock_.NowSeconds();
  const ChangedPages changed = ChangedPages::Between(*dataset_.current(), *next);
  const LiveDataset coming(dataset_, next);
  ModuleRegistry registry;
  if (Status status = RegisterStockModules(registry, coming, models_, options_); !status.ok()) return status;
  auto made = MakeAnew(paging_, changed, registry, clock_);
  std::unordered_map<DataType, std::unordered_map<Quadcode, std::unique_ptr<const Page>>> by_key;
  const size_t count = made.size();
  for (auto& [key, page] : made) by_key[key.type][key.node] = std::move(page);

  paging_.reading.Close();
  paging_.listing.Close();
  const double closed_s = clock_.NowSeconds();
  dataset_.Switch(next);
  for (const PageKey& key : paging_.cache.Keys(SharedCache::Which::kAll)) {
    if (paging_.layers.at(key.type).kind == PageKind::kModel || !changed.MayReach(key.node)) continue;
    auto& pages = by_key[key.type];
    const auto page = pages.find(key.node);
    if (page == pages.end())
      paging_.cache.Drop(key);
    else
      paging_.cache.Replace(key, std::move(page->second));
  }
  paging_.cache.ForgetFailures();
  paging_.generation.fetch_add(1, std::memory_order_release);
  const double opened_s = clock_.NowSeconds();
  paging_.listing.Open();
  paging_.reading.Open();

  const std::string what = changed.all() ? "all of its pages" : fmt::format("{} of its pages", changed.count());
  LogInfo("{} has changed: {} may differ; {} that are shown were made anew in {:.2f} s, and put in place in {:.3f} s",
          dataset_.path(), what, count, closed_s - start_s, opened_s - closed_s);
  std::vector<std::string> notices;
  for (size_t i = dataset_.layers().size(); i < next->layers().size(); ++i)
    notices.push_back(
        fmt::format("{} has a new layer {}; start again to see it", dataset_.path(), next->layers()[i].name));
  SetNotices(std::move(notices));
  return {};
}

void DatasetFollower::SetNotices(std::vector<std::string> notices) {
  const MutexLock lock(mutex_);
  notices_ = std::move(notices);
}

std::vector<std::string> DatasetFollower::Notices() const {
  const MutexLock lock(mutex_);
  return notices_;
}

}  // namespace belvedere

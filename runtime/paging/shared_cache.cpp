#include "runtime/paging/shared_cache.h"

#include "runtime/base/mutex.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <unordered_map>
#include <utility>

namespace belvedere {

// One resident page. Its links and stamp belong to the lock of its table. `pins` falls to 0 and rises from 0 only under
// that lock, so that "pinned by nobody" and "in the list" are the same thing; above 1 it changes freely.
struct PagePin::Entry {
  Entry(PageKey k, std::unique_ptr<const Page> p, size_t charge) : key(k), page(std::move(p)), charge_bytes(charge) {}

  const PageKey key;
  const std::unique_ptr<const Page> page;
  const size_t charge_bytes;
  std::atomic<int> pins{1};

  Entry* next_in_slot = nullptr;
  Entry* older = nullptr;  // neighbours in the list of unpinned pages
  Entry* newer = nullptr;
  uint64_t released_at = 0;  // tick at which the last pin was given back
  bool is_dropped = false;   // in no table any more: its last pin frees it
};

namespace {

constexpr uint64_t kNever = std::numeric_limits<uint64_t>::max();
// Failures of one data type whose reasons are kept; of any more only the keys are.
constexpr size_t kMostReasons = 16'384;

}  // namespace

struct SharedCache::Counters {
  std::atomic<size_t> resident_bytes{0};
  std::atomic<size_t> pinned_bytes{0};
  std::atomic<size_t> peak_bytes{0};
  std::atomic<uint64_t> evictions{0};
  std::atomic<uint64_t> tick{0};  // orders the release of pages over all tables

  void NotePeak(size_t resident) {
    size_t peak = peak_bytes.load(std::memory_order_relaxed);
    while (peak < resident && !peak_bytes.compare_exchange_weak(peak, resident, std::memory_order_relaxed)) {
    }
  }
};

// The hash table of one data type: slots of chained entries, as many slots as entries at least, a power of two; and the
// list of unpinned entries, the one released longest ago first.
struct SharedCache::Table {
  using Entry = PagePin::Entry;

  Table() : slots(kFirstSlots, nullptr) {}

  Entry* Lookup(Quadcode node) REQUIRES_LOCK(mutex) {
    Entry* entry = slots[SlotOf(node)];
    while (entry != nullptr && entry->key.node != node) entry = entry->next_in_slot;
    return entry;
  }

  void Add(Entry* entry) REQUIRES_LOCK(mutex) {
    if (entries == slots.size()) Grow();
    Entry*& slot = slots[SlotOf(entry->key.node)];
    entry->next_in_slot = slot;
    slot = entry;
    ++entries;
  }

  void Remove(Entry* entry) REQUIRES_LOCK(mutex) {
    Entry** link = &slots[SlotOf(entry->key.node)];
    while (*link != entry) link = &(*link)->next_in_slot;
    *link = entry->next_in_slot;
    --entries;
  }

  void PushNewest(Entry* entry) REQUIRES_LOCK(mutex) {
    entry->older = newest;
    entry->newer = nullptr;
    (newest != nullptr ? newest->newer : oldest) = entry;
    newest = entry;
    PublishOldest();
  }

  void Unlink(Entry* entry) REQUIRES_LOCK(mutex) {
    (entry->older != nullptr ? entry->older->newer : oldest) = entry->newer;
    (entry->newer != nullptr ? entry->newer->older : newest) = entry->older;
    PublishOldest();
  }

  // Nobody finds the page any more. The entry, to be freed; nothing where there is none, or its last pin will free it.
  std::unique_ptr<Entry> TakeOut(Quadcode node, Counters& counters) REQUIRES_LOCK(mutex) {
    Entry* const entry = Lookup(node);
    if (entry == nullptr) return nullptr;
    Remove(entry);
    entry->is_dropped = entry->pins.load(std::memory_order_relaxed) > 0;
    if (entry->is_dropped) return nullptr;
    Unlink(entry);
    counters.resident_bytes.fetch_sub(entry->charge_bytes, std::memory_order_relaxed);
    return std::unique_ptr<Entry>(entry);
  }

  // Counts one more pin of a resident entry.
  void Pin(Entry* entry, Counters& counters) REQUIRES_LOCK(mutex) {
    if (entry->pins.fetch_add(1, std::memory_order_relaxed) > 0) return;
    Unlink(entry);
    counters.pinned_bytes.fetch_add(entry->charge_bytes, std::memory_order_relaxed);
  }

  static constexpr size_t kFirstSlots = 64;

  mutable Mutex mutex;
  std::vector<Entry*> slots GUARDED_BY(mutex);
  size_t entries GUARDED_BY(mutex) = 0;
  Entry* oldest GUARDED_BY(mutex) = nullptr;
  Entry* newest GUARDED_BY(mutex) = nullptr;
  uint64_t hits GUARDED_BY(mutex) = 0;
  uint64_t misses GUARDED_BY(mutex) = 0;
  std::unordered_map<Quadcode, std::string> failures GUARDED_BY(mutex);
  // released_at of `oldest`, so that eviction can compare tables without their locks.
  std::atomic<uint64_t> oldest_released_at{kNever};

 private:
  size_t SlotOf(Quadcode node) const REQUIRES_LOCK(mutex) { return std::hash<Quadcode>()(node) & (slots.size() - 1); }

  void PublishOldest() REQUIRES_LOCK(mutex) {
    oldest_released_at.store(oldest != nullptr ? oldest->released_at : kNever, std::memory_order_release);
  }

  void Grow() REQUIRES_LOCK(mutex) {
    std::vector<Entry*> smaller(2 * slots.size(), nullptr);
    smaller.swap(slots);
    for (Entry* entry : smaller) {
      while (entry != nullptr) {
        Entry* const next = entry->next_in_slot;
        Entry*& slot = slots[SlotOf(entry->key.node)];
        entry->next_in_slot = slot;
        slot = entry;
        entry = next;
      }
    }
  }
};

// ---- PagePin
// ---------------------------------------------------------------------------------------------------------

PagePin::PagePin(PagePin&& other) noexcept
    : cache_(std::exchange(other.cache_, nullptr)), entry_(std::exchange(other.entry_, nullptr)) {}

PagePin& PagePin::operator=(PagePin&& other) noexcept {
  if (this != &other) {
    Release();
    cache_ = std::exchange(other.cache_, nullptr);
    entry_ = std::exchange(other.entry_, nullptr);
  }
  return *this;
}

PagePin PagePin::Share() const {
  if (entry_ == nullptr) return {};
  entry_->pins.fetch_add(1, std::memory_order_relaxed);  // it is 1 at least, for this pin is held
  return PagePin(cache_, entry_);
}

void PagePin::Release() {
  if (entry_ == nullptr) return;
  cache_->Unpin(std::exchange(entry_, nullptr));
  cache_ = nullptr;
}

const Page& PagePin::page() const {
  BELVEDERE_CHECK(entry_ != nullptr);
  return *entry_->page;
}

const PageKey& PagePin::key() const {
  BELVEDERE_CHECK(entry_ != nullptr);
  return entry_->key;
}

// ---- SharedCache
// -----------------------------------------------------------------------------------------------------

SharedCache::SharedCache(size_t budget_bytes, int data_types)
    : budget_bytes_(budget_bytes), counters_(std::make_unique<Counters>()) {
  BELVEDERE_CHECK(data_types >= 0);
  for (int type = 0; type < data_types; ++type) tables_.push_back(std::make_unique<Table>());
}

SharedCache::~SharedCache() {
  BELVEDERE_CHECK(PinnedBytes() == 0);
  while (EvictOne()) {
  }
}

size_t SharedCache::ChargeOf(const Page& page) {
  // The page, its entry, its share of the slots, and the residency that it owns beside itself.
  constexpr size_t kSharedPointerBlock = 16;
  return page.bytes() + sizeof(PagePin::Entry) + 2 * sizeof(PagePin::Entry*) + sizeof(Residency) + kSharedPointerBlock;
}

PagePin SharedCache::Find(const PageKey& key) {
  BELVEDERE_CHECK(key.type < tables_.size());
  Table& table = *tables_[key.type];
  MutexLock lock(table.mutex);
  PagePin::Entry* const entry = table.Lookup(key.node);
  if (entry == nullptr) {
    ++table.misses;
    return {};
  }
  ++table.hits;
  table.Pin(entry, *counters_);
  return PagePin(this, entry);
}

bool SharedCache::Contains(const PageKey& key) const {
  BELVEDERE_CHECK(key.type < tables_.size());
  Table& table = *tables_[key.type];
  MutexLock lock(table.mutex);
  return table.Lookup(key.node) != nullptr;
}

PagePin SharedCache::FindQuietly(const PageKey& key) {
  Table& table = *tables_[key.type];
  MutexLock lock(table.mutex);
  PagePin::Entry* const entry = table.Lookup(key.node);
  if (entry == nullptr) return {};
  table.Pin(entry, *counters_);
  return PagePin(this, entry);
}

PagePin SharedCache::Insert(const PageKey& key, std::unique_ptr<const Page> page) {
  BELVEDERE_CHECK(key.type < tables_.size() && page != nullptr);
  // Looked up before room is made, so that no page goes for the sake of one that is there already.
  if (PagePin present = FindQuietly(key)) return present;
  const size_t charge_bytes = ChargeOf(*page);
  auto added = std::make_unique<PagePin::Entry>(key, std::move(page), charge_bytes);
  Reserve(charge_bytes);

  Table& table = *tables_[key.type];
  {
    MutexLock lock(table.mutex);
    PagePin::Entry* const present = table.Lookup(key.node);
    if (present == nullptr) {
      counters_->pinned_bytes.fetch_add(charge_bytes, std::memory_order_relaxed);
      table.failures.erase(key.node);
      table.Add(added.get());
      return PagePin(this, added.release());
    }
    // Another thread was quicker; `added` is freed after the lock.
    counters_->resident_bytes.fetch_sub(charge_bytes, std::memory_order_relaxed);
    table.Pin(present, *counters_);
    return PagePin(this, present);
  }
}

// Adds to resident_bytes, first making room for it; over the budget only when nothing is left that could go.
void SharedCache::Reserve(size_t charge_bytes) {
  std::atomic<size_t>& resident = counters_->resident_bytes;
  size_t before = resident.load(std::memory_order_relaxed);
  while (true) {
    const bool fits = before + charge_bytes <= budget_bytes_;
    if (!fits && EvictOne()) {
      before = resident.load(std::memory_order_relaxed);
    } else if (resident.compare_exchange_weak(before, before + charge_bytes, std::memory_order_relaxed)) {
      break;
    }
  }
  counters_->NotePeak(before + charge_bytes);
}

// Frees the page that was released longest ago, of all data types; false when every resident page is pinned.
bool SharedCache::EvictOne() {
  while (true) {
    Table* stalest = nullptr;
    uint64_t released_at = kNever;
    for (const std::unique_ptr<Table>& table : tables_) {
      const uint64_t oldest = table->oldest_released_at.load(std::memory_order_acquire);
      if (oldest < released_at) {
        released_at = oldest;
        stalest = table.get();
      }
    }
    if (stalest == nullptr) return false;

    std::unique_ptr<PagePin::Entry> evicted;  // freed after the lock is released
    MutexLock lock(stalest->mutex);
    if (stalest->oldest == nullptr || stalest->oldest->released_at != released_at) continue;  // it changed meanwhile
    evicted.reset(stalest->oldest);
    stalest->Unlink(evicted.get());
    stalest->Remove(evicted.get());
    counters_->resident_bytes.fetch_sub(evicted->charge_bytes, std::memory_order_relaxed);
    counters_->evictions.fetch_add(1, std::memory_order_relaxed);
    return true;
  }
}

void SharedCache::Unpin(PagePin::Entry* entry) {
  int pins = entry->pins.load(std::memory_order_relaxed);
  while (pins > 1) {
    if (entry->pins.compare_exchange_weak(pins, pins - 1, std::memory_order_release)) return;
  }
  std::unique_ptr<PagePin::Entry> dropped;  // freed after the lock is released
  {
    Table& table = *tables_[entry->key.type];
    MutexLock lock(table.mutex);
    if (entry->pins.fetch_sub(1, std::memory_order_acq_rel) > 1) return;  // found again meanwhile
    counters_->pinned_bytes.fetch_sub(entry->charge_bytes, std::memory_order_relaxed);
    if (entry->is_dropped) {
      counters_->resident_bytes.fetch_sub(entry->charge_bytes, std::memory_order_relaxed);
      dropped.reset(entry);
      return;
    }
    entry->released_at = counters_->tick.fetch_add(1, std::memory_order_relaxed);
    table.PushNewest(entry);
  }
  while (counters_->resident_bytes.load(std::memory_order_relaxed) > budget_bytes_ && EvictOne()) {
  }
}

std::vector<PageKey> SharedCache::Keys(Which which) const {
  std::vector<PageKey> keys;
  for (const std::unique_ptr<Table>& table : tables_) {
    MutexLock lock(table->mutex);
    for (const PagePin::Entry* entry : table->slots) {
      for (; entry != nullptr; entry = entry->next_in_slot) {
        const bool is_pinned = entry->pins.load(std::memory_order_relaxed) > 0;
        if (which == Which::kAll || is_pinned) keys.push_back(entry->key);
      }
    }
  }
  return keys;
}

void SharedCache::Replace(const PageKey& key, std::unique_ptr<const Page> page) {
  BELVEDERE_CHECK(key.type < tables_.size() && page != nullptr);
  const size_t charge_bytes = ChargeOf(*page);
  auto added = std::make_unique<PagePin::Entry>(key, std::move(page), charge_bytes);
  Reserve(charge_bytes);
  std::unique_ptr<PagePin::Entry> freed;  // after the lock is released
  PagePin pin;
  {
    Table& table = *tables_[key.type];
    MutexLock lock(table.mutex);
    freed = table.TakeOut(key.node, *counters_);
    counters_->pinned_bytes.fetch_add(charge_bytes, std::memory_order_relaxed);
    table.failures.erase(key.node);
    table.Add(added.get());
    pin = PagePin(this, added.release());
  }
}

void SharedCache::Drop(const PageKey& key) {
  BELVEDERE_CHECK(key.type < tables_.size());
  std::unique_ptr<PagePin::Entry> freed;  // after the lock is released
  Table& table = *tables_[key.type];
  MutexLock lock(table.mutex);
  freed = table.TakeOut(key.node, *counters_);
}

void SharedCache::ForgetFailures() {
  for (const std::unique_ptr<Table>& table : tables_) {
    MutexLock lock(table->mutex);
    table->failures.clear();
  }
}

void SharedCache::MarkFailed(const PageKey& key, const Status& reason) {
  BELVEDERE_CHECK(key.type < tables_.size() && !reason.ok());
  Table& table = *tables_[key.type];
  MutexLock lock(table.mutex);
  if (table.Lookup(key.node) != nullptr) return;  // it is there after all
  const bool keep_reason = table.failures.size() < kMostReasons;
  table.failures.insert_or_assign(key.node, keep_reason ? reason.message() : std::string());
}

void SharedCache::Forget(const PageKey& key) {
  BELVEDERE_CHECK(key.type < tables_.size());
  Table& table = *tables_[key.type];
  MutexLock lock(table.mutex);
  table.failures.erase(key.node);
}

Status SharedCache::FailureOf(const PageKey& key) const {
  BELVEDERE_CHECK(key.type < tables_.size());
  Table& table = *tables_[key.type];
  MutexLock lock(table.mutex);
  const auto failure = table.failures.find(key.node);
  if (failure == table.failures.end()) return {};
  if (!failure->second.empty()) return Status::Error("{}", failure->second);
  return Status::Error("{}: failed, as more than {} pages of its layer did; run belvedere-build verify on the dataset",
                       key.node.ToString(), kMostReasons);
}

std::vector<std::string> SharedCache::Failures(size_t most) const {
  std::vector<std::string> reasons;
  for (const std::unique_ptr<Table>& table : tables_) {
    MutexLock lock(table->mutex);
    for (const auto& [node, reason] : table->failures) {
      if (reasons.size() == most) return reasons;
      if (!reason.empty()) reasons.push_back(reason);
    }
  }
  return reasons;
}

SharedCache::Statistics SharedCache::Stats() const {
  Statistics statistics;
  statistics.budget_bytes = budget_bytes_;
  statistics.resident_bytes = counters_->resident_bytes.load(std::memory_order_relaxed);
  statistics.pinned_bytes = counters_->pinned_bytes.load(std::memory_order_relaxed);
  statistics.peak_bytes = counters_->peak_bytes.load(std::memory_order_relaxed);
  statistics.evictions = counters_->evictions.load(std::memory_order_relaxed);
  for (const std::unique_ptr<Table>& table : tables_) {
    MutexLock lock(table->mutex);
    statistics.resident_pages += table->entries;
    statistics.hits += table->hits;
    statistics.misses += table->misses;
    statistics.failed_pages += table->failures.size();
  }
  return statistics;
}

size_t SharedCache::PinnedBytes() const {
  return counters_->pinned_bytes.load(std::memory_order_relaxed);
}

}  // namespace belvedere

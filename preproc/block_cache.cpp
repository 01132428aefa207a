#include "preproc/block_cache.h"

#include <algorithm>

namespace belvedere {

void BlockCache::Use(uint64_t key, Entry& entry) {
  by_worth_.erase({entry.worth, entry.use});
  entry.worth = let_go_ + entry.cost;
  entry.use = ++uses_;
  by_worth_[{entry.worth, entry.use}] = key;
}

std::shared_ptr<const Block> BlockCache::Find(uint64_t key) {
  const MutexLock lock(mutex_);
  const auto found = entries_.find(key);
  if (found == entries_.end()) return nullptr;
  Use(key, found->second);
  return found->second.block;
}

void BlockCache::Insert(uint64_t key, std::shared_ptr<const Block> block, double cost) {
  std::vector<std::shared_ptr<const Block>> evicted;  // freed after the lock is
  const MutexLock lock(mutex_);
  const auto [entry, is_new] = entries_.try_emplace(key);
  if (!is_new) return;
  bytes_ += block->bytes();
  entry->second.block = std::move(block);
  entry->second.cost = cost;
  Use(key, entry->second);
  while (bytes_ > budget_bytes_ && entries_.size() > 1) {
    auto least = by_worth_.begin();
    if (least->second == key) ++least;  // somebody is waiting for it
    const auto out = entries_.find(least->second);
    let_go_ = std::max(let_go_, out->second.worth);
    bytes_ -= out->second.block->bytes();
    evicted.push_back(std::move(out->second.block));
    by_worth_.erase(least);
    entries_.erase(out);
  }
}

}  // namespace belvedere

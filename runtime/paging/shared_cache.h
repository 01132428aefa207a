// SharedCache: every page that is in memory, once, for all views. One hash table a data type, keyed by quadcode.
//
// A page enters through Insert, is found and pinned through Find, and stays while anybody holds a PagePin of it. A page
// that nobody pins stays too, until its bytes are needed: then the one pinned longest ago goes first. The budget counts
// every page, pinned or not. Pins are never taken back, so pinned pages alone may exceed the budget; whoever chooses
// pages asks PinnedBytes() and stops refining before that happens (managers do).
//
// A page that could not be read or made is a state too: MarkFailed keeps the reason, Find returns no pin, and FailureOf
// says why. A failure is final until Forget, or until a page of that key is inserted after all.
//
// Insert of a key that is resident keeps the page that is there, so that two servers that made the same page by chance
// agree: use the pin that Insert returns.
//
// Threads: any. One lock a data type, held for the hash table and the list only; pages are freed after it is released.
// Owns: the pages, jointly with the pins.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/page.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace belvedere {

class SharedCache;

// Keeps one page resident and alive. Move-only; releasing the last pin of a page makes it evictable, not gone.
class PagePin {
 public:
  PagePin() = default;
  PagePin(PagePin&& other) noexcept;
  PagePin& operator=(PagePin&& other) noexcept;
  PagePin(const PagePin&) = delete;
  PagePin& operator=(const PagePin&) = delete;
  ~PagePin() { Release(); }

  // Another pin of the same page.
  PagePin Share() const;
  void Release();

  explicit operator bool() const { return entry_ != nullptr; }
  // REQUIRES: holds a page.
  const Page& page() const;
  const PageKey& key() const;
  // REQUIRES: the page is of type T (the data type says which it is).
  template <typename T>
  const T& as() const {
    return static_cast<const T&>(page());
  }

 private:
  friend class SharedCache;
  struct Entry;
  PagePin(SharedCache* cache, Entry* entry) : cache_(cache), entry_(entry) {}

  SharedCache* cache_ = nullptr;
  Entry* entry_ = nullptr;
};

class SharedCache {
 public:
  struct Statistics {
    size_t budget_bytes = 0;
    size_t resident_bytes = 0;
    size_t pinned_bytes = 0;
    size_t peak_bytes = 0;  // high-water mark of resident_bytes
    size_t resident_pages = 0;
    uint64_t hits = 0;
    uint64_t misses = 0;
    uint64_t evictions = 0;
    uint64_t failed_pages = 0;  // keys marked failed now
  };

  // data_types: keys' types run from 0 to data_types - 1.
  SharedCache(size_t budget_bytes, int data_types);
  // REQUIRES: no pin is held.
  ~SharedCache();
  SharedCache(const SharedCache&) = delete;
  SharedCache& operator=(const SharedCache&) = delete;

  // The page, pinned; an empty pin when it is not resident. Counts a hit or a miss, and marks the page as used now.
  PagePin Find(const PageKey& key);
  // Whether Find would succeed; counts nothing.
  bool Contains(const PageKey& key) const;
  // Adds the page, evicts what the budget asks for, and returns it pinned (or the one that was already there).
  PagePin Insert(const PageKey& key, std::unique_ptr<const Page> page);

  // Which pages there are, those of lower data types first.
  enum class Which { kAll, kPinned };
  std::vector<PageKey> Keys(Which which) const;
  // The page takes the place of the one that is there, in one step. The old one stays for those that hold pins of it,
  // and goes with the last; it counts until then.
  void Replace(const PageKey& key, std::unique_ptr<const Page> page);
  // Nobody finds the page any more; else as Replace.
  void Drop(const PageKey& key);
  // Lets all that failed be tried again.
  void ForgetFailures();

  // reason: one line that names the page, the cause and where.
  void MarkFailed(const PageKey& key, const Status& reason);
  // ok when the key has not failed.
  Status FailureOf(const PageKey& key) const;
  // Lets a failed page be tried again.
  void Forget(const PageKey& key);
  // Every failure there is, for the user; at most `most`.
  std::vector<std::string> Failures(size_t most) const;

  Statistics Stats() const;
  size_t PinnedBytes() const;
  // What a page counts against the budget: its own bytes and what the cache keeps with it.
  static size_t ChargeOf(const Page& page);
  size_t budget_bytes() const { return budget_bytes_; }

 private:
  friend class PagePin;
  struct Table;

  void Unpin(PagePin::Entry* entry);
  PagePin FindQuietly(const PageKey& key);
  void Reserve(size_t charge_bytes);
  bool EvictOne();

  const size_t budget_bytes_;
  std::vector<std::unique_ptr<Table>> tables_;
  struct Counters;
  std::unique_ptr<Counters> counters_;
};

}  // namespace belvedere

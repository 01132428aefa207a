#include "runtime/paging/shared_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <list>
#include <map>
#include <random>
#include <set>
#include <thread>

namespace belvedere {
namespace {

// A page of a chosen size that counts how many of its kind are alive.
class CountedPage final : public Page {
 public:
  CountedPage(size_t bytes, int label, std::atomic<int>* alive) : label_(label), bytes_(bytes), alive_(alive) {
    if (alive_ != nullptr) ++*alive_;
  }
  ~CountedPage() override {
    if (alive_ != nullptr) --*alive_;
  }
  size_t bytes() const override { return bytes_; }
  int label() const { return label_; }

 private:
  int label_;
  size_t bytes_;
  std::atomic<int>* alive_;
};

std::unique_ptr<const Page> MakePage(size_t bytes, int label = 0, std::atomic<int>* alive = nullptr) {
  return std::make_unique<CountedPage>(bytes, label, alive);
}

PageKey Key(int type, int64_t column) {
  return {static_cast<DataType>(type), Quadcode::FromColumnRow(10, column, column % 4096)};
}

size_t Charge(size_t bytes) {
  return SharedCache::ChargeOf(CountedPage(bytes, 0, nullptr));
}

TEST(SharedCache, FindsWhatWasInserted) {
  SharedCache cache(1'000'000, 2);
  EXPECT_FALSE(cache.Find(Key(0, 1)));
  PagePin inserted = cache.Insert(Key(0, 1), MakePage(100, 7));
  ASSERT_TRUE(inserted);
  EXPECT_EQ(inserted.key(), Key(0, 1));
  const PagePin found = cache.Find(Key(0, 1));
  ASSERT_TRUE(found);
  EXPECT_EQ(found.as<CountedPage>().label(), 7);
  EXPECT_EQ(&found.page(), &inserted.page());
  EXPECT_TRUE(cache.Contains(Key(0, 1)));
  EXPECT_FALSE(cache.Contains(Key(1, 1)));  // the same quadcode of another data type
  EXPECT_EQ(cache.Stats().hits, 1u);
  EXPECT_EQ(cache.Stats().misses, 1u);
}

TEST(SharedCache, InsertKeepsThePageThatIsThere) {
  std::atomic<int> alive{0};
  SharedCache cache(1'000'000, 1);
  const PagePin first = cache.Insert(Key(0, 1), MakePage(100, 1, &alive));
  const PagePin second = cache.Insert(Key(0, 1), MakePage(100, 2, &alive));
  EXPECT_EQ(second.as<CountedPage>().label(), 1);
  EXPECT_EQ(alive, 1);
  EXPECT_EQ(cache.Stats().resident_bytes, Charge(100));
}

TEST(SharedCache, PinsMoveShareAndRelease) {
  SharedCache cache(1'000'000, 1);
  PagePin pin = cache.Insert(Key(0, 1), MakePage(100));
  EXPECT_EQ(cache.PinnedBytes(), Charge(100));
  PagePin shared = pin.Share();
  pin.Release();
  EXPECT_FALSE(pin);
  EXPECT_EQ(cache.PinnedBytes(), Charge(100));
  PagePin moved = std::move(shared);
  EXPECT_EQ(cache.PinnedBytes(), Charge(100));
  moved = PagePin();
  EXPECT_EQ(cache.PinnedBytes(), 0u);
  EXPECT_TRUE(cache.Contains(Key(0, 1)));
  EXPECT_FALSE(PagePin().Share());
}

TEST(SharedCache, EvictsTheLeastRecentlyUsedOverAllTypes) {
  SharedCache cache(3 * Charge(100), 3);
  cache.Insert(Key(0, 1), MakePage(100));
  cache.Insert(Key(1, 1), MakePage(100));
  cache.Insert(Key(2, 1), MakePage(100));
  cache.Find(Key(0, 1));                    // used now
  cache.Insert(Key(2, 2), MakePage(100));   // needs room
  EXPECT_FALSE(cache.Contains(Key(1, 1)));  // the least recently used, though of another type
  EXPECT_TRUE(cache.Contains(Key(0, 1)));
  EXPECT_TRUE(cache.Contains(Key(2, 1)));
  EXPECT_EQ(cache.Stats().evictions, 1u);
}

TEST(SharedCache, PinnedPagesMayExceedTheBudgetAndGoWhenReleased) {
  SharedCache cache(2 * Charge(100), 1);
  std::vector<PagePin> pins;
  for (int i = 0; i < 5; ++i) pins.push_back(cache.Insert(Key(0, i), MakePage(100)));
  EXPECT_EQ(cache.Stats().resident_bytes, 5 * Charge(100));
  pins.clear();
  EXPECT_EQ(cache.Stats().resident_bytes, 2 * Charge(100));
  EXPECT_TRUE(cache.Contains(Key(0, 4)));
  EXPECT_EQ(cache.Stats().peak_bytes, 5 * Charge(100));
}

TEST(SharedCache, AFailureStaysUntilForgottenOrOvertaken) {
  SharedCache cache(1'000'000, 1);
  EXPECT_TRUE(cache.FailureOf(Key(0, 1)).ok());
  cache.MarkFailed(Key(0, 1), Status::Error("page 1 is damaged"));
  EXPECT_EQ(cache.FailureOf(Key(0, 1)).message(), "page 1 is damaged");
  EXPECT_FALSE(cache.Find(Key(0, 1)));
  EXPECT_EQ(cache.Stats().failed_pages, 1u);
  EXPECT_EQ(cache.Failures(10), std::vector<std::string>{"page 1 is damaged"});
  EXPECT_TRUE(cache.Failures(0).empty());
  cache.Forget(Key(0, 1));
  EXPECT_TRUE(cache.FailureOf(Key(0, 1)).ok());
  cache.MarkFailed(Key(0, 2), Status::Error("page 2 is damaged"));
  cache.Insert(Key(0, 2), MakePage(100));
  EXPECT_TRUE(cache.FailureOf(Key(0, 2)).ok());
  cache.MarkFailed(Key(0, 2), Status::Error("said too late"));  // it is resident
  EXPECT_EQ(cache.Stats().failed_pages, 0u);
}

TEST(SharedCache, AReplacedPageStaysForItsPins) {
  std::atomic<int> alive{0};
  SharedCache cache(1'000'000, 2);
  PagePin old = cache.Insert(Key(0, 1), MakePage(100, 1, &alive));
  cache.Replace(Key(0, 1), MakePage(200, 2, &alive));
  EXPECT_EQ(old.as<CountedPage>().label(), 1);
  EXPECT_EQ(cache.Find(Key(0, 1)).as<CountedPage>().label(), 2);
  EXPECT_EQ(cache.Stats().resident_bytes, Charge(100) + Charge(200)) << "both count while both are there";
  PagePin shared = old.Share();
  old.Release();
  EXPECT_EQ(alive, 2);
  shared.Release();
  EXPECT_EQ(alive, 1);
  EXPECT_EQ(cache.Stats().resident_bytes, Charge(200));
  EXPECT_EQ(cache.PinnedBytes(), 0u);
  cache.Replace(Key(1, 5), MakePage(10, 3, &alive));  // where nothing was
  EXPECT_TRUE(cache.Contains(Key(1, 5)));
}

TEST(SharedCache, ADroppedPageIsFoundNoMore) {
  std::atomic<int> alive{0};
  SharedCache cache(1'000'000, 1);
  const PagePin pinned = cache.Insert(Key(0, 1), MakePage(100, 1, &alive));
  cache.Insert(Key(0, 2), MakePage(100, 2, &alive));
  cache.Insert(Key(0, 3), MakePage(100, 3, &alive));
  for (int i = 1; i <= 2; ++i) cache.Drop(Key(0, i));
  cache.Drop(Key(0, 9));
  EXPECT_EQ(alive, 2) << "one is pinned";
  EXPECT_FALSE(cache.Find(Key(0, 1)));
  EXPECT_FALSE(cache.Find(Key(0, 2)));
  EXPECT_TRUE(cache.Find(Key(0, 3)));
  EXPECT_EQ(cache.Insert(Key(0, 1), MakePage(100, 4, &alive)).as<CountedPage>().label(), 4);
}

TEST(SharedCache, ListsItsKeys) {
  SharedCache cache(1'000'000, 3);
  const PagePin pinned = cache.Insert(Key(2, 7), MakePage(100));
  cache.Insert(Key(0, 1), MakePage(100));
  const auto all = cache.Keys(SharedCache::Which::kAll);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0], Key(0, 1));
  EXPECT_EQ(cache.Keys(SharedCache::Which::kPinned), (std::vector<PageKey>{Key(2, 7)}));
  cache.MarkFailed(Key(1, 1), Status::Error("bad"));
  cache.ForgetFailures();
  EXPECT_TRUE(cache.FailureOf(Key(1, 1)).ok());
}

TEST(SharedCache, FreesEverything) {
  std::atomic<int> alive{0};
  {
    SharedCache cache(1'000'000, 2);
    for (int i = 0; i < 1000; ++i) cache.Insert(Key(i % 2, i), MakePage(64, i, &alive));
    EXPECT_GT(alive, 0);
  }
  EXPECT_EQ(alive, 0);
}

// What the cache promises, written as plainly as can be: a list in order of release and a map of pins.
class ModelCache {
 public:
  explicit ModelCache(size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  bool Contains(const PageKey& key) const { return bytes_.contains(key); }
  void Pin(const PageKey& key) {
    released_.remove(key);
    ++pins_[key];
  }
  void Insert(const PageKey& key, size_t charge_bytes) {
    if (!Contains(key)) {
      EvictUntil(charge_bytes);
      bytes_[key] = charge_bytes;
    }
    Pin(key);
  }
  void Unpin(const PageKey& key) {
    if (--pins_[key] > 0) return;
    released_.push_back(key);
    EvictUntil(0);
  }
  size_t ResidentBytes() const {
    size_t sum = 0;
    for (const auto& [key, charge_bytes] : bytes_) sum += charge_bytes;
    return sum;
  }
  size_t PinnedBytes() const {
    size_t sum = 0;
    for (const auto& [key, pins] : pins_) sum += pins > 0 ? bytes_.at(key) : 0;
    return sum;
  }
  size_t pages() const { return bytes_.size(); }

 private:
  void EvictUntil(size_t room_bytes) {
    while (!released_.empty() && ResidentBytes() + room_bytes > budget_bytes_) {
      bytes_.erase(released_.front());
      pins_.erase(released_.front());
      released_.pop_front();
    }
  }

  size_t budget_bytes_;
  std::map<PageKey, size_t> bytes_;
  std::map<PageKey, int> pins_;
  std::list<PageKey> released_;
};

TEST(SharedCache, BehavesAsItsModel) {
  constexpr int kTypes = 3;
  const size_t budget_bytes = 20 * Charge(500);
  SharedCache cache(budget_bytes, kTypes);
  ModelCache model(budget_bytes);
  std::mt19937 random(20260101);
  std::vector<PagePin> pins;
  for (int step = 0; step < 20'000; ++step) {
    const PageKey key = Key(static_cast<int>(random() % kTypes), static_cast<int64_t>(random() % 40));
    switch (random() % 4) {
      case 0: {
        const size_t bytes = 100 + random() % 900;
        pins.push_back(cache.Insert(key, MakePage(bytes)));
        model.Insert(key, Charge(bytes));
        break;
      }
      case 1: {
        PagePin pin = cache.Find(key);
        ASSERT_EQ(static_cast<bool>(pin), model.Contains(key));
        if (pin) {
          model.Pin(key);
          pins.push_back(std::move(pin));
        }
        break;
      }
      default: {
        if (pins.empty()) break;
        const size_t which = random() % pins.size();
        std::swap(pins[which], pins.back());
        const PageKey released = pins.back().key();
        pins.pop_back();
        model.Unpin(released);
      }
    }
    const SharedCache::Statistics statistics = cache.Stats();
    ASSERT_EQ(statistics.resident_bytes, model.ResidentBytes()) << "step " << step;
    ASSERT_EQ(statistics.pinned_bytes, model.PinnedBytes());
    ASSERT_EQ(statistics.resident_pages, model.pages());
    ASSERT_LE(statistics.resident_bytes, std::max(budget_bytes, statistics.pinned_bytes));
  }
  EXPECT_GT(cache.Stats().evictions, 100u);
}

TEST(SharedCache, StaysConsistentUnderContention) {
  constexpr int kThreads = 4;
  constexpr int kSteps = 4000;
  std::atomic<int> alive{0};
  const size_t budget_bytes = 64 * Charge(1000);
  {
    SharedCache cache(budget_bytes, 2);
    std::atomic<int> wrong{0};
    const auto work = [&](unsigned seed) {
      std::mt19937 random(seed);
      std::array<PagePin, 8> held;  // fewer, over all threads, than the budget has room for
      for (int step = 0; step < kSteps; ++step) {
        const int label = static_cast<int>(random() % 200);
        const PageKey key = Key(label % 2, label);
        PagePin& pin = held[random() % held.size()];
        pin = random() % 2 == 0 ? cache.Find(key) : cache.Insert(key, MakePage(1000, label, &alive));
        if (pin && pin.as<CountedPage>().label() != label) ++wrong;
        if (pin && random() % 8 == 0) held[random() % held.size()] = pin.Share();
        if (random() % 64 == 0) cache.MarkFailed(Key(0, 1000 + label), Status::Error("failed"));
        if (random() % 64 == 0) cache.Stats();
      }
    };
    std::vector<std::thread> threads;
    for (unsigned thread = 0; thread < kThreads; ++thread) threads.emplace_back(work, thread + 1);
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
    const SharedCache::Statistics statistics = cache.Stats();
    EXPECT_EQ(statistics.pinned_bytes, 0u);
    EXPECT_LE(statistics.peak_bytes, budget_bytes);
    EXPECT_EQ(statistics.resident_bytes, statistics.resident_pages * Charge(1000));
    EXPECT_EQ(static_cast<size_t>(alive), statistics.resident_pages);
    EXPECT_GT(statistics.evictions, 0u);
  }
  EXPECT_EQ(alive, 0);
}

}  // namespace
}  // namespace belvedere

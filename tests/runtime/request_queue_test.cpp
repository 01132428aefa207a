#include "runtime/paging/request_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <thread>

namespace belvedere {
namespace {

PageKey Key(int64_t number) {
  return {0, Quadcode::FromColumnRow(12, number, 5000)};
}

TEST(RequestQueue, GivesTheMostWantedFirst) {
  ManualClock clock;
  RequestQueue queue(100, clock);
  queue.SetWishes(1, std::vector<Wish>{{Key(1), 1}, {Key(2), 3}, {Key(3), 2}, {Key(4), 3}});
  EXPECT_EQ(queue.TryTake(), Key(2));  // first come, first served among equals
  EXPECT_EQ(queue.TryTake(), Key(4));
  EXPECT_EQ(queue.TryTake(), Key(3));
  EXPECT_EQ(queue.TryTake(), Key(1));
  EXPECT_EQ(queue.TryTake(), std::nullopt);
}

TEST(RequestQueue, AnObsoleteWishIsNeverServed) {
  ManualClock clock;
  RequestQueue queue(100, clock);
  queue.SetWishes(1, std::vector<Wish>{{Key(1), 9}, {Key(2), 1}});
  queue.SetWishes(1, std::vector<Wish>{{Key(2), 1}});
  EXPECT_EQ(queue.TryTake(), Key(2));
  EXPECT_EQ(queue.TryTake(), std::nullopt);
  EXPECT_EQ(queue.Stats().cancelled, 1u);
}

TEST(RequestQueue, PrioritiesRiseAndSinkWhileTheyWait) {
  ManualClock clock;
  RequestQueue queue(100, clock);
  queue.SetWishes(1, std::vector<Wish>{{Key(1), 1}, {Key(2), 2}, {Key(3), 3}});
  queue.SetWishes(1, std::vector<Wish>{{Key(1), 10}, {Key(2), 2}, {Key(3), 1}});
  EXPECT_EQ(queue.TryTake(), Key(1));
  EXPECT_EQ(queue.TryTake(), Key(2));
  EXPECT_EQ(queue.TryTake(), Key(3));
}

TEST(RequestQueue, TakesTheGreatestPriorityOfAllViews) {
  ManualClock clock;
  RequestQueue queue(100, clock);
  queue.SetWishes(1, std::vector<Wish>{{Key(1), 1}, {Key(2), 2}});
  queue.SetWishes(2, std::vector<Wish>{{Key(1), 5}});
  EXPECT_EQ(queue.Stats().waiting, 2u);
  queue.SetWishes(3, std::vector<Wish>{{Key(1), 4}});
  queue.SetWishes(2, {});  // what view 1 and 3 want stays
  EXPECT_EQ(queue.TryTake(), Key(1));
  EXPECT_EQ(queue.TryTake(), Key(2));
}

TEST(RequestQueue, ATakenPageIsNotGivenTwice) {
  ManualClock clock;
  RequestQueue queue(100, clock);
  const std::vector<Wish> wishes{{Key(1), 1}};
  queue.SetWishes(1, wishes);
  EXPECT_EQ(queue.TryTake(), Key(1));
  queue.SetWishes(1, wishes);
  queue.SetWishes(2, wishes);
  EXPECT_EQ(queue.TryTake(), std::nullopt);
  queue.SetWishes(1, {});
  queue.SetWishes(2, {});
  queue.Done(Key(1));
  EXPECT_EQ(queue.Stats().served, 1u);
  EXPECT_EQ(queue.Stats().cancelled, 0u);
  queue.SetWishes(1, wishes);  // gone from the cache again
  EXPECT_EQ(queue.TryTake(), Key(1));
}

TEST(RequestQueue, DropsTheLeastWantedOverItsCapacity) {
  ManualClock clock;
  RequestQueue queue(3, clock);
  queue.SetWishes(1, std::vector<Wish>{{Key(1), 1}, {Key(2), 2}, {Key(3), 3}});
  queue.SetWishes(2, std::vector<Wish>{{Key(4), 4}, {Key(5), 0}, {Key(6), 2.5f}, {Key(7), -1}, {Key(8), -2}});
  EXPECT_EQ(queue.Stats().waiting, 3u);
  EXPECT_EQ(queue.Stats().peak_waiting, 3u);
  EXPECT_EQ(queue.TryTake(), Key(4));
  EXPECT_EQ(queue.TryTake(), Key(3));
  EXPECT_EQ(queue.TryTake(), Key(6));
  EXPECT_EQ(queue.TryTake(), std::nullopt);
}

TEST(RequestQueue, AWishMadeTwiceAtOnceCountsOnce) {
  ManualClock clock;
  RequestQueue queue(10, clock);
  queue.SetWishes(1, std::vector<Wish>{{Key(1), 1}, {Key(2), 2}, {Key(1), 3}, {Key(3), std::nanf("")}});
  EXPECT_EQ(queue.Stats().issued, 3u);
  EXPECT_EQ(queue.TryTake(), Key(1));
  EXPECT_EQ(queue.TryTake(), Key(2));
  EXPECT_EQ(queue.TryTake(), Key(3));  // a priority that is no number is the least
}

TEST(RequestQueue, MeasuresTheWait) {
  ManualClock clock;
  RequestQueue queue(1000, clock);
  std::vector<Wish> wishes;
  for (int i = 0; i < 100; ++i) wishes.push_back({Key(i), static_cast<float>(-i)});
  queue.SetWishes(1, wishes);
  for (int i = 0; i < 100; ++i) {
    clock.Advance(0.010);
    ASSERT_EQ(queue.TryTake(), Key(i));
  }
  EXPECT_NEAR(queue.Stats().p95_wait_ms, 950, 11);
}

// What the queue promises, written plainly: each view's wishes in a map, searched in full.
TEST(RequestQueue, BehavesAsItsModel) {
  ManualClock clock;
  RequestQueue queue(1'000'000, clock);
  std::map<ViewId, std::map<PageKey, float>> wished;
  std::set<PageKey> taken;
  std::mt19937 random(7);
  for (int step = 0; step < 4000; ++step) {
    const auto view = static_cast<ViewId>(random() % 3);
    switch (random() % 3) {
      case 0: {
        std::map<PageKey, float> wishes;
        for (uint64_t i = random() % 30; i > 0; --i) {
          wishes[Key(static_cast<int64_t>(random() % 60))] = static_cast<float>(random() % 1000);
        }
        std::vector<Wish> list;
        for (const auto& [key, priority] : wishes) list.push_back({key, priority});
        std::shuffle(list.begin(), list.end(), random);
        queue.SetWishes(view, list);
        wished[view] = wishes;
        break;
      }
      case 1: {
        float greatest = -1;
        for (const auto& [unused, wishes] : wished) {
          for (const auto& [key, priority] : wishes) {
            if (!taken.contains(key)) greatest = std::max(greatest, priority);
          }
        }
        const std::optional<PageKey> key = queue.TryTake();
        ASSERT_EQ(key.has_value(), greatest >= 0) << "step " << step;
        if (!key) break;
        float own = -1;
        for (auto& [unused, wishes] : wished) {
          if (wishes.contains(*key)) own = std::max(own, wishes[*key]);
        }
        ASSERT_EQ(own, greatest);
        ASSERT_TRUE(taken.insert(*key).second);
        break;
      }
      default: {
        if (taken.empty()) break;
        const PageKey key = *taken.begin();
        queue.Done(key);
        taken.erase(key);
        for (auto& [unused, wishes] : wished) wishes.erase(key);  // who still wants it wishes again
      }
    }
    const RequestQueue::Statistics statistics = queue.Stats();
    ASSERT_EQ(statistics.issued, statistics.served + statistics.cancelled + statistics.waiting + taken.size());
  }
  EXPECT_GT(queue.Stats().served, 100u);
}

TEST(RequestQueue, WakesWhoWaitsAndStops) {
  ManualClock clock;
  RequestQueue queue(64, clock);
  std::atomic<int> taken{0};
  std::atomic<int> twice{0};
  std::array<std::atomic<int>, 64> holders{};
  std::vector<std::thread> servers;
  for (int server = 0; server < 3; ++server) {
    servers.emplace_back([&] {
      while (const std::optional<PageKey> key = queue.Take()) {
        if (holders[static_cast<size_t>(key->node.column())]++ != 0) ++twice;
        ++taken;
        --holders[static_cast<size_t>(key->node.column())];
        queue.Done(*key);
      }
    });
  }
  std::vector<std::thread> views;
  for (ViewId view = 0; view < 2; ++view) {
    views.emplace_back([&, view] {
      std::mt19937 random(view);
      for (int round = 0; round < 500; ++round) {
        std::vector<Wish> wishes;
        for (int i = 0; i < 16; ++i)
          wishes.push_back({Key(static_cast<int64_t>(random() % 64)), static_cast<float>(random() % 100)});
        queue.SetWishes(view, wishes);
      }
      const std::vector<Wish> last{{Key(view), 1}};
      queue.SetWishes(view, last);
    });
  }
  for (std::thread& view : views) view.join();
  while (queue.Stats().waiting > 0) std::this_thread::yield();
  queue.Stop();
  for (std::thread& server : servers) server.join();
  EXPECT_EQ(twice, 0);
  EXPECT_GT(taken, 0);
  EXPECT_EQ(queue.Stats().served, static_cast<uint64_t>(taken));
  EXPECT_EQ(queue.Take(), std::nullopt);
}

}  // namespace
}  // namespace belvedere

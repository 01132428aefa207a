#include "servers/page_server.h"

#include "runtime/base/clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <stdexcept>

namespace belvedere {
namespace {

// A page that says which one it is.
struct NumberPage final : Page {
  explicit NumberPage(uint64_t n) : number(n) {}
  size_t bytes() const override { return 1000; }
  uint64_t number;
};

Quadcode Node(int64_t number) {
  return Quadcode::FromColumnRow(8, number, 100);
}

ReadModule Numbers(std::string layer, std::atomic<int>* reads) {
  ReadModule module;
  module.layer = std::move(layer);
  module.max_level = 8;
  module.exists = [](Quadcode node) { return node.level() == 8; };
  module.read = [reads](ReadContext&, Quadcode node) -> Result<std::unique_ptr<Page>> {
    ++*reads;
    if (node.column() % 10 == 3) return Status::Error("page {} is damaged", node.ToString());
    if (node.column() % 10 == 4) throw std::runtime_error("the library gave up");
    if (node.column() % 10 == 5) throw 5;
    return std::unique_ptr<Page>(std::make_unique<NumberPage>(node.word()));
  };
  return module;
}

// A layer that is made of another: twice its number.
ReadModule Doubles(std::string layer, DataType of) {
  ReadModule module = Numbers(std::move(layer), nullptr);
  module.threads = 2;
  module.read = [of](ReadContext& context, Quadcode node) -> Result<std::unique_ptr<Page>> {
    const Result<PagePin> single = context.Obtain(of, node);
    if (!single.ok()) return single.status();
    return std::unique_ptr<Page>(std::make_unique<NumberPage>(2 * single->as<NumberPage>().number));
  };
  return module;
}

void WaitUntilServed(RequestQueue& queue, uint64_t pages) {
  while (queue.Stats().served < pages) std::this_thread::yield();
}

TEST(PageServer, ServesWishesAndMarksFailures) {
  std::atomic<int> reads{0};
  ModuleRegistry registry;
  ASSERT_TRUE(registry.Add(Numbers("numbers", &reads)).ok());
  Paging paging(MakeLayerTable(registry), 10'000'000, Clock::System());
  ServerSet servers(paging, registry);
  EXPECT_EQ(servers.threads(), 1);
  std::vector<Wish> wishes;
  for (int i = 0; i < 10; ++i) wishes.push_back({{0, Node(i)}, static_cast<float>(i)});
  paging.queue(0).SetWishes(1, wishes);
  WaitUntilServed(paging.queue(0), 10);
  for (int i = 0; i < 10; ++i) {
    const PageKey key{0, Node(i)};
    const bool fails = i >= 3 && i <= 5;
    EXPECT_EQ(paging.cache.Contains(key), !fails) << i;
    EXPECT_EQ(paging.cache.FailureOf(key).ok(), !fails) << i;
  }
  EXPECT_NE(paging.cache.FailureOf({0, Node(4)}).message().find("the library gave up"), std::string::npos);
  EXPECT_NE(paging.cache.FailureOf({0, Node(5)}).message().find(Node(5).ToString()), std::string::npos);
  EXPECT_EQ(reads, 10);

  paging.queue(0).SetWishes(1, std::vector<Wish>{{{0, Node(3)}, 1}, {{0, Node(1)}, 1}});
  WaitUntilServed(paging.queue(0), 12);
  EXPECT_EQ(reads, 10);  // neither what is there nor what failed is read again
}

TEST(PageServer, OneLayerIsMadeOfAnother) {
  std::atomic<int> reads{0};
  ModuleRegistry registry;
  ASSERT_TRUE(registry.Add(Numbers("numbers", &reads)).ok());
  ASSERT_TRUE(registry.Add(Doubles("doubles", registry.Find("numbers")->type)).ok());
  EXPECT_FALSE(registry.Add(Doubles("doubles", 0)).ok());
  Paging paging(MakeLayerTable(registry), 10'000'000, Clock::System());
  ServerSet servers(paging, registry);
  EXPECT_EQ(servers.threads(), 3);
  paging.queue(1).SetWishes(1, std::vector<Wish>{{{1, Node(1)}, 1}, {{1, Node(2)}, 2}, {{1, Node(3)}, 3}});
  WaitUntilServed(paging.queue(1), 3);
  EXPECT_EQ(paging.cache.Find({1, Node(2)}).as<NumberPage>().number, 2 * Node(2).word());
  EXPECT_TRUE(paging.cache.Contains({0, Node(1)}));
  EXPECT_FALSE(paging.cache.FailureOf({0, Node(3)}).ok());
  EXPECT_FALSE(paging.cache.FailureOf({1, Node(3)}).ok());
}

TEST(PageServer, ManyViewsAndServersShareASmallCache) {
  std::atomic<int> reads{0};
  ModuleRegistry registry;
  ASSERT_TRUE(registry.Add(Numbers("numbers", &reads)).ok());
  ASSERT_TRUE(registry.Add(Doubles("doubles", 0)).ok());
  constexpr size_t kBudget = 40'000;
  Paging paging(MakeLayerTable(registry), kBudget, Clock::System());
  std::atomic<int> wrong{0};
  {
    ServerSet servers(paging, registry);
    std::vector<std::thread> views;
    for (ViewId view = 0; view < 2; ++view) {
      views.emplace_back([&, view] {
        std::mt19937 random(view);
        for (int round = 0; round < 300; ++round) {
          std::vector<Wish> wishes;
          for (int i = 0; i < 12; ++i)
            wishes.push_back({{1, Node(10 * static_cast<int64_t>(random() % 60))}, static_cast<float>(i)});
          paging.queue(1).SetWishes(view, wishes);
          for (const Wish& wish : wishes) {
            const PagePin pin = paging.cache.Find(wish.key);
            if (pin && pin.as<NumberPage>().number != 2 * wish.key.node.word()) ++wrong;
          }
        }
      });
    }
    for (std::thread& view : views) view.join();
    WaitUntilServed(paging.queue(1), 1);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(paging.cache.Stats().peak_bytes, kBudget);
  EXPECT_EQ(paging.cache.PinnedBytes(), 0u);
}

}  // namespace
}  // namespace belvedere

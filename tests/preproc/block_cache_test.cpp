#include "preproc/block_cache.h"

#include <gtest/gtest.h>

#include <thread>

namespace belvedere {
namespace {

constexpr size_t kBytes = 100;

std::shared_ptr<const Block> OfBytes(size_t bytes) {
  auto block = std::make_shared<Block>();
  block->coverage.resize(bytes);
  return block;
}

TEST(BlockCache, OfEqualCostTheLeastRecentlyUsedGoes) {
  BlockCache cache(3 * kBytes);
  for (const uint64_t key : {1U, 2U, 3U}) cache.Insert(key, OfBytes(kBytes), 1);
  EXPECT_NE(cache.Find(1), nullptr);
  cache.Insert(4, OfBytes(kBytes), 1);
  EXPECT_EQ(cache.Find(2), nullptr);
  for (const uint64_t key : {1U, 3U, 4U}) EXPECT_NE(cache.Find(key), nullptr) << key;
}

TEST(BlockCache, WhatIsDearStaysWhileAsManyGoAsItCosts) {
  constexpr uint64_t kDear = 1000;
  constexpr double kCost = 16;
  BlockCache cache(5 * kBytes);
  cache.Insert(kDear, OfBytes(kBytes), kCost);
  // Four others fit beside it: with each four that are let go the least worth rises by one.
  uint64_t key = 0;
  for (; key < 4 * 15; ++key) cache.Insert(key, OfBytes(kBytes), 1);
  EXPECT_NE(cache.Find(kDear), nullptr) << "and this was a use";
  for (const uint64_t end = key + 4 * 15; key < end; ++key) cache.Insert(key, OfBytes(kBytes), 1);
  EXPECT_NE(cache.Find(kDear), nullptr);
  for (const uint64_t end = key + 4 * 20; key < end; ++key) cache.Insert(key, OfBytes(kBytes), 1);
  EXPECT_EQ(cache.Find(kDear), nullptr) << "but not for ever";
}

TEST(BlockCache, ABlockThatIsTooLargeIsKeptUntilTheNext) {
  BlockCache cache(kBytes);
  cache.Insert(1, OfBytes(5 * kBytes), 1);
  EXPECT_NE(cache.Find(1), nullptr);
  cache.Insert(2, OfBytes(kBytes), 1);
  EXPECT_EQ(cache.Find(1), nullptr);
  EXPECT_NE(cache.Find(2), nullptr);
}

TEST(BlockCache, ManyThreadsShareIt) {
  BlockCache cache(50 * kBytes);
  std::vector<std::thread> threads;
  for (uint64_t thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&cache, thread] {
      for (uint64_t i = 0; i < 2000; ++i) {
        const uint64_t key = (i * 7 + thread * 13) % 90;
        const std::shared_ptr<const Block> found = cache.Find(key);
        if (found == nullptr) {
          cache.Insert(key, OfBytes(kBytes + key), static_cast<double>(key % 5 + 1));
        } else {
          EXPECT_EQ(found->bytes(), kBytes + key);
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace belvedere

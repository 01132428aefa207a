#include "render/slot_pool.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

constexpr uint64_t kLater = 1000;

int Put(SlotPool& pool, const std::shared_ptr<Residency>& page, uint64_t frame) {
  const auto slot = pool.Take(frame);
  EXPECT_TRUE(slot.has_value());
  if (slot) pool.Fill(*slot, page, frame);
  return slot.value_or(-1);
}

TEST(SlotPool, FillsEmptySlotsFirst) {
  SlotPool pool(2, 10);
  const auto a = std::make_shared<Residency>();
  const auto b = std::make_shared<Residency>();
  EXPECT_EQ(Put(pool, a, 1), 10);
  EXPECT_EQ(Put(pool, b, 1), 11);
  EXPECT_EQ(a->TryPin(), 10);
  EXPECT_EQ(pool.filled(), 2);
  EXPECT_TRUE(pool.Owns(11));
  EXPECT_FALSE(pool.Owns(12));
  EXPECT_FALSE(pool.Owns(9));
  a->Unpin();
}

TEST(SlotPool, TakesTheSlotUsedLongestAgo) {
  SlotPool pool(3);
  const std::shared_ptr<Residency> pages[] = {std::make_shared<Residency>(), std::make_shared<Residency>(),
                                              std::make_shared<Residency>()};
  for (const auto& page : pages) Put(pool, page, 1);
  pool.Touch(0, 30);
  pool.Touch(1, 20);
  pool.Touch(2, 25);
  EXPECT_EQ(Put(pool, std::make_shared<Residency>(), kLater), 1);
  EXPECT_FALSE(pages[1]->on_gpu());
  EXPECT_TRUE(pages[0]->on_gpu());
  EXPECT_EQ(pool.evicted(), 1U);
}

TEST(SlotPool, NeverTakesAPinnedSlot) {
  SlotPool pool(2);
  const auto old = std::make_shared<Residency>();
  const auto young = std::make_shared<Residency>();
  Put(pool, old, 1);
  Put(pool, young, 2);
  ASSERT_TRUE(old->TryPin());
  EXPECT_EQ(pool.Take(kLater), 1);
  EXPECT_TRUE(old->on_gpu());
  old->Unpin();
}

TEST(SlotPool, RefusesWhenEverythingIsPinned) {
  SlotPool pool(1);
  const auto page = std::make_shared<Residency>();
  Put(pool, page, 1);
  ASSERT_TRUE(page->TryPin());
  EXPECT_FALSE(pool.Take(kLater));
  EXPECT_EQ(pool.refused(), 1U);
  page->Unpin();
  EXPECT_TRUE(pool.Take(kLater));
}

TEST(SlotPool, LeavesTimeToPinWhatWasJustPlaced) {
  SlotPool pool(1);
  const auto page = std::make_shared<Residency>();
  Put(pool, page, 100);
  EXPECT_FALSE(pool.Take(100 + SlotPool::kGraceFrames - 1));
  EXPECT_TRUE(pool.Take(100 + SlotPool::kGraceFrames));
}

TEST(SlotPool, TheSlotOfAPageThatIsGoneIsFreeAtOnce) {
  SlotPool pool(2);
  const auto lives = std::make_shared<Residency>();
  auto dies = std::make_shared<Residency>();
  Put(pool, lives, 1);
  Put(pool, dies, 1);
  dies.reset();
  EXPECT_EQ(pool.Take(2), 1);
  EXPECT_TRUE(lives->on_gpu());
}

TEST(SlotPool, PagesAreNowhereOnceThePoolIsGone) {
  const auto page = std::make_shared<Residency>();
  {
    SlotPool pool(1);
    Put(pool, page, 1);
    EXPECT_TRUE(page->on_gpu());
  }
  EXPECT_FALSE(page->on_gpu());
}

}  // namespace
}  // namespace belvedere

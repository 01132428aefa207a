#include "managers/label_layout.h"

#include <gtest/gtest.h>

#include <random>

namespace belvedere {
namespace {

LabelWish Wish(float x, float y, float distance_m, bool before = false) {
  LabelWish wish;
  wish.anchor_px = {x, y};
  wish.beside_px = 10;
  wish.distance_m = distance_m;
  wish.size = {10, 2};
  wish.shown_before = before;
  return wish;
}

LabelBox PlacedBox(const LabelWish& wish, LabelSide side) {
  LabelBox box = BoxOf(side, wish.beside_px, wish.size);
  return {box.left + wish.anchor_px.x, box.top + wish.anchor_px.y, box.right + wish.anchor_px.x,
          box.bottom + wish.anchor_px.y, box.has_leader};
}

TEST(LabelLayout, TheNearerComesFirstAndTheOtherStandsOff) {
  LabelLayout layout;
  const std::vector<LabelWish> wishes = {Wish(400, 300, 2000), Wish(410, 300, 1000)};
  const auto places = layout.Lay(wishes, 1024, 768);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].wish, 1u);
  EXPECT_EQ(places[0].side, LabelSide::kRight);
  EXPECT_EQ(places[1].wish, 0u);
  EXPECT_NE(places[1].side, LabelSide::kRight);
  EXPECT_TRUE(BoxOf(places[1].side, 10, {10, 2}).has_leader);
}

TEST(LabelLayout, WhatWasShownStaysThoughANearerOneComes) {
  LabelLayout layout;
  std::vector<LabelWish> wishes = {Wish(400, 300, 2000, true)};
  wishes[0].side_before = LabelSide::kLowerLeft;
  for (int i = 0; i < 9; ++i) wishes.push_back(Wish(400, 300, 1000));
  const auto places = layout.Lay(wishes, 1024, 768);
  ASSERT_FALSE(places.empty());
  EXPECT_EQ(places[0].wish, 0u);
  EXPECT_EQ(places[0].side, LabelSide::kLowerLeft);
}

TEST(LabelLayout, NoTwoOfTenThousandOverlapAndNobodyFlickers) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> x(-50, 1074), y(-50, 818), distance(100, 1e5F), step(-1, 1);
  std::vector<LabelWish> wishes(10'000);
  for (LabelWish& wish : wishes) wish = Wish(x(random), y(random), distance(random));
  LabelLayout layout;
  std::vector<LabelPlace> before;
  size_t lost = 0, shown = 0;
  for (int list = 0; list < 20; ++list) {
    const auto places = layout.Lay(wishes, 1024, 768);
    EXPECT_LE(places.size(), kMostLabels);
    for (size_t a = 0; a < places.size(); ++a) {
      const LabelBox one = PlacedBox(wishes[places[a].wish], places[a].side);
      for (size_t b = 0; b < a; ++b) {
        const LabelBox other = PlacedBox(wishes[places[b].wish], places[b].side);
        EXPECT_FALSE(one.left < other.right && other.left < one.right && one.top < other.bottom &&
                     other.top < one.bottom);
      }
    }
    for (const LabelPlace& place : before) {
      const bool still = std::any_of(places.begin(), places.end(), [&](auto& now) { return now.wish == place.wish; });
      lost += still ? 0u : 1u;
    }
    shown += before.size();
    before.assign(places.begin(), places.end());
    for (LabelWish& wish : wishes) {
      wish.shown_before = false;
      wish.anchor_px += glm::vec2(step(random), step(random));
    }
    for (const LabelPlace& place : before) {
      wishes[place.wish].shown_before = true;
      wishes[place.wish].side_before = place.side;
    }
  }
  EXPECT_GT(before.size(), 60u);
  EXPECT_LT(lost, shown / 20);
}

}  // namespace
}  // namespace belvedere

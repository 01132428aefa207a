#include "render/upload_order.h"

#include <gtest/gtest.h>

#include <memory>

namespace belvedere {
namespace {

struct NoPage final : Page {
  size_t bytes() const override { return sizeof(*this); }
};

class UploadOrder : public ::testing::Test {
 protected:
  PagePin Page(int number) {
    return cache_.Insert({0, Quadcode::FromColumnRow(10, number, 2000)}, std::make_unique<NoPage>());
  }
  std::vector<int64_t> Order(const std::vector<std::vector<PagePin>>& lists, size_t turn) {
    std::vector<std::span<const PagePin>> wishes(lists.begin(), lists.end());
    std::vector<int64_t> numbers;
    for (const PagePin* pin : FairUploadOrder(wishes, turn)) numbers.push_back(pin->key().node.column());
    return numbers;
  }
  std::vector<PagePin> List(std::initializer_list<int> numbers) {
    std::vector<PagePin> pins;
    for (const int number : numbers) pins.push_back(Page(number));
    return pins;
  }
  SharedCache cache_{1 << 20, 1};
};

TEST_F(UploadOrder, ListsTakeTurns) {
  std::vector<std::vector<PagePin>> lists;
  lists.push_back(List({1, 2, 3}));
  lists.push_back(List({11}));
  lists.push_back(List({21, 22}));
  EXPECT_EQ(Order(lists, 0), (std::vector<int64_t>{1, 11, 21, 2, 22, 3}));
  EXPECT_EQ(Order(lists, 1), (std::vector<int64_t>{11, 21, 1, 22, 2, 3}));
}

TEST_F(UploadOrder, APageThatTwoViewsWantComesOnce) {
  std::vector<std::vector<PagePin>> lists;
  lists.push_back(List({1, 2}));
  lists.push_back(List({2, 1}));
  EXPECT_EQ(Order(lists, 0), (std::vector<int64_t>{1, 2}));
}

TEST_F(UploadOrder, WhatIsThereIsLeftOut) {
  std::vector<std::vector<PagePin>> lists;
  lists.push_back(List({1, 2}));
  lists[0][0].page().residency()->Place(0);
  EXPECT_EQ(Order(lists, 0), (std::vector<int64_t>{2}));
}

TEST_F(UploadOrder, NothingIsWanted) {
  EXPECT_TRUE(Order({}, 5).empty());
}

}  // namespace
}  // namespace belvedere

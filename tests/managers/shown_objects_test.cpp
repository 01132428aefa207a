#include "managers/shown_objects.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

ObjectRecord At(uint32_t slot, uint32_t incarnation) {
  ObjectRecord record;
  record.slot = slot;
  record.incarnation = incarnation;
  return record;
}

TEST(ShownObjects, AreRememberedWhileTheyAreShown) {
  ShownObjects shown;
  shown.Show(At(5, 1), 1).labelled = true;
  shown.Show(At(2, 2), 1);
  shown.Show(At(9, 3), 1);
  shown.ForgetOthers(1);
  EXPECT_EQ(shown.size(), 3u);
  EXPECT_TRUE(shown.Show(At(5, 1), 2).labelled);
  shown.Show(At(9, 3), 2).labelled = true;
  shown.ForgetOthers(2);
  EXPECT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown.Find(2), nullptr);
  EXPECT_EQ(shown.Find(77), nullptr);
  EXPECT_TRUE(shown.Find(9)->labelled);
}

TEST(ShownObjects, AnotherObjectInTheSlotIsNew) {
  ShownObjects shown;
  shown.Show(At(5, 1), 1).labelled = true;
  EXPECT_FALSE(shown.Show(At(5, 8), 2).labelled);
  EXPECT_EQ(shown.size(), 1u);
}

}  // namespace
}  // namespace belvedere

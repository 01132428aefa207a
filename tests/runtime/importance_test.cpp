#include "runtime/scene/importance.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

ImportanceFacts Facts(double speed, double distance) {
  ImportanceFacts facts{};
  facts[static_cast<size_t>(ImportanceInput::kSpeed)] = speed;
  facts[static_cast<size_t>(ImportanceInput::kDistance)] = distance;
  return facts;
}

TEST(Importance, ATermIsATrapezoid) {
  const FuzzyTerm term{ImportanceInput::kSpeed, 10, 20, 30, 50};
  const auto held = [&](double speed) { return term.HeldBy(Facts(speed, 0)); };
  EXPECT_EQ(held(5), 0);
  EXPECT_EQ(held(15), 0.5);
  EXPECT_EQ(held(20), 1);
  EXPECT_EQ(held(30), 1);
  EXPECT_EQ(held(40), 0.5);
  EXPECT_EQ(held(60), 0);
  const FuzzyTerm step{ImportanceInput::kSpeed, 0, 0, 5, 5};  // upright on both sides
  EXPECT_EQ(step.HeldBy(Facts(0, 0)), 1);
  EXPECT_EQ(step.HeldBy(Facts(5.1, 0)), 0);
}

TEST(Importance, RulesAreWeighedByHowMuchTheyHold) {
  const FuzzyTerm fast{ImportanceInput::kSpeed, 100, 200, 1e9, 1e9}, near{ImportanceInput::kDistance, 0, 0, 10, 20};
  const ImportanceTable table({{{fast}, 1.0}, {{near}, 0.5}, {{fast, near}, 0.0}});
  EXPECT_EQ(table.Of(Facts(0, 100)), kUsualImportance);  // no rule holds
  EXPECT_EQ(table.Of(Facts(300, 100)), 1.0);
  EXPECT_EQ(table.Of(Facts(0, 0)), 0.5);
  EXPECT_EQ(table.Of(Facts(300, 0)), 0.5);             // (1 + 0.5 + 0) / 3
  EXPECT_NEAR(table.Of(Facts(150, 100)), 1.0, 1e-12);  // half of one alone
  EXPECT_EQ(ImportanceTable().Of(Facts(1, 1)), kUsualImportance);
}

TEST(Importance, InputsHaveNames) {
  for (size_t i = 0; i < kImportanceInputs; ++i) {
    const auto input = static_cast<ImportanceInput>(i);
    EXPECT_EQ(ImportanceInputOf(NameOf(input)), input);
  }
  EXPECT_EQ(ImportanceInputOf("colour"), ImportanceInput::kCount);
}

}  // namespace
}  // namespace belvedere

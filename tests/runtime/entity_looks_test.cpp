#include "runtime/scene/entity_looks.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

constexpr EntityType kAirliner{1, 2, 225, 57, 1, 2, 3};

TEST(EntityPattern, FitsNumbersAndStars) {
  EXPECT_TRUE(EntityPattern::Parse("1.2.225.57.1.2.3")->Fits(kAirliner));
  EXPECT_TRUE(EntityPattern::Parse("1.2.*.57")->Fits(kAirliner));
  EXPECT_TRUE(EntityPattern::Parse("1.2.*.57.*.*.*")->Fits(kAirliner));
  EXPECT_TRUE(EntityPattern::Parse("")->Fits(kAirliner));
  EXPECT_FALSE(EntityPattern::Parse("1.1")->Fits(kAirliner));
  EXPECT_FALSE(EntityPattern::Parse("1.2.*.57.1.2.4")->Fits(kAirliner));
}

TEST(EntityPattern, RefusesWhatIsNoPattern) {
  for (const char* text : {"a", "1..2", "1.2.", "1.2.3.4.5.6.7.8", "-1", "1.70000", "1.*2"}) {
    EXPECT_FALSE(EntityPattern::Parse(text)) << text;
  }
}

TEST(EntityLooks, TheFirstRuleThatFitsWins) {
  const EntityLooks looks({{*EntityPattern::Parse("1.2.*.57"), {4, SymbolShape::kAir}},
                           {*EntityPattern::Parse("1.2"), {5, SymbolShape::kAir}}});
  EXPECT_EQ(looks.LookOf(kAirliner).model, 4);
  EXPECT_EQ(looks.LookOf({1, 2, 225, 1, 0, 0, 0}).model, 5);
}

TEST(EntityLooks, AnUnknownTypeHasTheSymbolOfItsDomain) {
  const EntityLooks looks;
  EXPECT_EQ(looks.LookOf(kAirliner).model, -1);
  EXPECT_EQ(looks.LookOf(kAirliner).symbol, SymbolShape::kAir);
  EXPECT_EQ(looks.LookOf({1, 1, 0, 0, 0, 0, 0}).symbol, SymbolShape::kGround);
  EXPECT_EQ(looks.LookOf({1, 3, 0, 0, 0, 0, 0}).symbol, SymbolShape::kSurface);
  EXPECT_EQ(looks.LookOf({1, 4, 0, 0, 0, 0, 0}).symbol, SymbolShape::kSubsurface);
  EXPECT_EQ(looks.LookOf({}).symbol, SymbolShape::kOther);
}

}  // namespace
}  // namespace belvedere

#include "managers/step_change.h"

#include <gtest/gtest.h>

#include <vector>

namespace belvedere {
namespace {

// A layer without steps, and one with a step every hundred seconds: data types 1 to 4.
LayerTable Table() {
  LayerTable table;
  table.Add({"plain", PageKind::kColour, 0, 5, [](Quadcode) { return true; }});
  for (int step = 0; step < 4; ++step) {
    Layer layer{"clouds" + (step == 0 ? "" : "@" + std::to_string(step)), PageKind::kColour, 0, 5,
                [](Quadcode) { return true; }};
    layer.step = StepOf{"clouds", 100.0 * step, Repeats::kNever};
    table.Add(std::move(layer));
  }
  return table;
}

class StepChangeTest : public testing::Test {
 protected:
  // One list: which step is to be shown, and which before, when so many quadnodes are left on that.
  struct Steps {
    DataType now = 0, before = 0;
    bool operator==(const Steps&) const = default;
  };
  Steps List(double utc_s, double now_s, int left, bool jump = false) {
    const std::vector<LayerUse> uses = change_.Next(layers_, table_, utc_s, now_s, jump);
    EXPECT_EQ(uses[0].type, 0) << "a layer without steps is itself";
    EXPECT_EQ(change_.before()[0], 0);
    const Steps steps{uses[1].type, change_.before()[1]};
    change_.Shown({0, steps.now == steps.before ? 0 : left}, now_s);
    return steps;
  }

  const LayerTable table_ = Table();
  std::vector<LayerUse> layers_{{0}, {1}};
  StepChange change_;
};

TEST_F(StepChangeTest, TheFirstListShowsTheStepOfItsTime) {
  EXPECT_EQ(List(250, 0, 9), (Steps{3, 3}));
  EXPECT_FALSE(change_.changing());
}

TEST_F(StepChangeTest, ShowsTheStepBeforeUntilAllQuadnodesHaveChangedOver) {
  List(50, 0, 0);
  EXPECT_FALSE(change_.IsDue(layers_, table_, 99));
  EXPECT_TRUE(change_.IsDue(layers_, table_, 100));
  EXPECT_EQ(List(100, 1, 9), (Steps{2, 1}));
  EXPECT_TRUE(change_.changing());
  EXPECT_EQ(List(101, 2, 4), (Steps{2, 1}));
  EXPECT_EQ(List(102, 3, 0), (Steps{2, 1}));
  EXPECT_FALSE(change_.changing());
  EXPECT_EQ(List(103, 4, 0), (Steps{2, 2}));
}

TEST_F(StepChangeTest, WhereTimeRunsFastNoMoreThanTwoStepsTakePart) {
  List(50, 0, 0);
  EXPECT_EQ(List(150, 1, 9), (Steps{2, 1}));
  EXPECT_EQ(List(250, 2, 5), (Steps{2, 1})) << "the next but one waits";
  EXPECT_EQ(List(350, 3, 0), (Steps{2, 1}));
  EXPECT_TRUE(change_.IsDue(layers_, table_, 350));
  EXPECT_EQ(List(350, 4, 9), (Steps{4, 2})) << "and what has passed by is left out";
}

TEST_F(StepChangeTest, BackInTimeToo) {
  List(350, 0, 0);
  EXPECT_EQ(List(10, 1, 1), (Steps{1, 4}));
}

TEST_F(StepChangeTest, AChangeThatComesNoFurtherIsEnded) {
  List(50, 0, 0);
  List(150, 1, 9);
  List(150, 1 + 0.9 * StepChange::kPatience_s, 8);  // it does come further
  List(150, 1 + 1.8 * StepChange::kPatience_s, 8);
  EXPECT_TRUE(change_.changing());
  List(150, 1 + 2.0 * StepChange::kPatience_s, 8);
  EXPECT_FALSE(change_.changing());
  EXPECT_EQ(List(150, 20, 0), (Steps{2, 2}));
}

TEST_F(StepChangeTest, NothingIsKeptWhereTheEyeHasJumpedOrTheLayerIsOff) {
  List(50, 0, 0);
  EXPECT_EQ(List(150, 1, 9, true), (Steps{2, 2}));
  List(250, 2, 9);
  layers_[1].on = false;
  EXPECT_EQ(List(350, 3, 9), (Steps{4, 4}));
}

TEST_F(StepChangeTest, OtherLayersStartAnew) {
  List(50, 0, 0);
  List(150, 1, 9);
  layers_ = {{0}, {3}};
  EXPECT_EQ(List(150, 2, 9), (Steps{3, 3})) << "a step named for itself does not change";
  EXPECT_FALSE(change_.IsDue(layers_, table_, 350));
}

}  // namespace
}  // namespace belvedere

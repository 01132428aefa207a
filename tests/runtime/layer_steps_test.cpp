#include "runtime/paging/layer_steps.h"

#include "runtime/base/iso_time.h"

#include <gtest/gtest.h>

#include <vector>

namespace belvedere {
namespace {

double At(const char* text) {
  return *ParseIsoTime(text);
}

TEST(LayerSteps, TheLastOneAtOrBeforeTheTimeHolds) {
  const std::vector<LayerStep> steps{{At("2003-05-01"), 0}, {At("2003-06-01"), 1}, {At("2005-01-01"), 2}};
  const auto step = [&](const char* time) { return StepAt(steps, Repeats::kNever, At(time)); };
  EXPECT_EQ(step("2003-05-31T23:59:59Z"), 0U);
  EXPECT_EQ(step("2003-06-01T00:00:00Z"), 1U);
  EXPECT_EQ(step("2004-12-31T23:59:59Z"), 1U);
  EXPECT_EQ(step("2026-01-01"), 2U) << "the last one holds for ever";
  EXPECT_EQ(step("1969-07-20"), 0U) << "before all of them it is the first";
}

TEST(LayerSteps, WhatRepeatsEveryYearGoesByTheDate) {
  const std::vector<LayerStep> steps{{At("2004-01-16"), 0}, {At("2004-03-01"), 1}, {At("2004-12-15"), 2}};
  const auto step = [&](const char* time) { return StepAt(steps, Repeats::kEveryYear, At(time)); };
  for (const char* year : {"1950", "2003", "2004", "2005", "2100", "2400"}) {
    const std::string of(year);
    EXPECT_EQ(step((of + "-01-15T23:59:59Z").c_str()), 2U) << year << ": December goes on into January";
    EXPECT_EQ(step((of + "-01-16").c_str()), 0U) << year;
    EXPECT_EQ(step((of + "-02-28T23:59:59Z").c_str()), 0U) << year;
    EXPECT_EQ(step((of + "-03-01").c_str()), 1U) << year << ": with a 29th of February or without";
    EXPECT_EQ(step((of + "-12-31T23:59:59Z").c_str()), 2U) << year;
  }
  EXPECT_EQ(step("2024-02-29T12:00:00Z"), 0U);
}

TEST(LayerSteps, OneStepHoldsAlways) {
  const std::vector<LayerStep> steps{{At("2004-06-01"), 7}};
  for (const Repeats repeats : {Repeats::kNever, Repeats::kEveryYear}) {
    EXPECT_EQ(StepAt(steps, repeats, At("2004-01-01")), 0U);
    EXPECT_EQ(StepAt(steps, repeats, At("2004-07-01")), 0U);
  }
}

TEST(LayerSteps, YearsAndDatesOfTimesBefore1970) {
  EXPECT_EQ(YearOf(At("1969-12-31T23:59:59Z")), 1969);
  EXPECT_EQ(YearOf(At("2004-01-01T00:00:00Z")), 2004);
  EXPECT_DOUBLE_EQ(SecondsIntoYear(At("1969-01-02T00:00:01Z")), 86'401);
}

}  // namespace
}  // namespace belvedere

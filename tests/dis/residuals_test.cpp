#include "dis/residuals.h"

#include "dis/timestamp.h"
#include "tests/dis/fixtures.h"

#include <gtest/gtest.h>

namespace belvedere::dis {
namespace {

TEST(Residuals, AreWhatAReportDiffersFromTheOneBefore) {
  Residuals residuals;
  EntityState state = SomeEntity();
  state.model = 2;
  state.velocity_mps = {10, 0, 0};
  const uint32_t before_the_hour = MakeTimestamp(3599.0, false), after_it = MakeTimestamp(1.0, false);
  residuals.Add(state, before_the_hour);
  EXPECT_TRUE(residuals.position_m().empty());
  state.position_ecef.x += 20.5;  // half a metre further than 2 s at 10 m/s
  state.orientation_rad.x += 0.1f;
  residuals.Add(state, after_it);
  ASSERT_EQ(residuals.position_m().size(), 1u);
  EXPECT_NEAR(residuals.position_m()[0], 0.5, 1e-4);
  EXPECT_NEAR(residuals.turn_rad()[0], 0.1, 1e-3);
  residuals.Add(SomeEntity(8), after_it);
  EXPECT_EQ(residuals.entities(), 2u);
  EXPECT_EQ(residuals.position_m().size(), 1u);
}

TEST(Residuals, ValuesAreRanked) {
  EXPECT_EQ(ValueAt({}, 0.5), 0.0);
  EXPECT_EQ(ValueAt({3, 1, 2}, 0.0), 1.0);
  EXPECT_EQ(ValueAt({3, 1, 2}, 0.5), 2.0);
  EXPECT_EQ(ValueAt({3, 1, 2}, 1.0), 3.0);
}

}  // namespace
}  // namespace belvedere::dis

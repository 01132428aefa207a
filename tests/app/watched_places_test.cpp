#include "runtime/app/watched_places.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

const glm::dvec3 kHere{6'378'137, 0, 0};

TEST(WatchedPlacesTest, AnAreaIsShownWhileItIsDrawnAndKeptWhenItIsFinished) {
  WatchedPlaces places({{kHere, 100}});
  places.Draw(kHere, kHere + glm::dvec3(0, 30, 40), false);
  EXPECT_EQ(places.areas().size(), 1U);
  ASSERT_EQ(places.Shown().size(), 2U);
  EXPECT_EQ(places.Shown()[1].radius_m, 50);
  places.Draw(kHere, kHere + glm::dvec3(0, 60, 80), true);
  ASSERT_EQ(places.areas().size(), 2U);
  EXPECT_EQ(places.areas()[1].radius_m, 100);
  EXPECT_EQ(places.Shown().size(), 2U);
}

TEST(WatchedPlacesTest, TheSmallestAreaAboutAPointIsTakenAway) {
  WatchedPlaces places({{kHere, 100}, {kHere + glm::dvec3(0, 10, 0), 20}, {kHere, 1000}});
  places.Draw(kHere, kHere + glm::dvec3(0, 0, 300), false);
  places.Click(kHere);  // a drag that came back to where it began
  EXPECT_EQ(places.Shown().size(), 3U);
  places.Click(kHere);
  ASSERT_EQ(places.areas().size(), 2U);
  EXPECT_EQ(places.areas()[0].radius_m, 100);
  EXPECT_EQ(places.areas()[1].radius_m, 1000);
  places.Click(kHere + glm::dvec3(0, 2000, 0));
  EXPECT_EQ(places.areas().size(), 2U);
  places.Clear();
  EXPECT_TRUE(places.Shown().empty());
}

TEST(WatchedPlacesTest, TheirNumberHasABound) {
  WatchedPlaces places({});
  for (size_t i = 0; i < kMostWatched + 3; ++i) {
    places.Draw(kHere, kHere + glm::dvec3(0, 0, 10.0 + static_cast<double>(i)), true);
  }
  ASSERT_EQ(places.areas().size(), kMostWatched);
  EXPECT_EQ(places.areas()[0].radius_m, 13);  // the oldest went
}

}  // namespace
}  // namespace belvedere

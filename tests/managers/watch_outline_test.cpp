#include "managers/watch_outline.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

TEST(WatchOutlineTest, TheRimLiesOnTheGroundAtTheRadius) {
  for (const Geodetic& place : {Geodetic{46, 8, 500}, Geodetic{90, 0, 500}, Geodetic{-10, 180, 500}}) {
    const WatchArea area{ToEcef(place), 20'000};
    std::vector<EffectInstance> effects;
    AddOutline(
        area, ToEcef({place.latitude_deg, place.longitude_deg, 1500}), [](double, double) { return 500.0; }, effects);
    ASSERT_EQ(effects.size(), static_cast<size_t>(kRimPieces));
    for (size_t i = 0; i < effects.size(); ++i) {
      EXPECT_NEAR(glm::distance(effects[i].from_ecef, area.centre_ecef), 20'000, 100);
      EXPECT_NEAR(ToGeodetic(effects[i].from_ecef).height_m, 560, 15);  // a little above, for the eye is 20 km away
      EXPECT_EQ(effects[i].to_ecef, effects[(i + 1) % effects.size()].from_ecef);
    }
  }
}

TEST(WatchOutlineTest, AnAreaOfNoSizeHasNone) {
  std::vector<EffectInstance> effects;
  AddOutline(
      {{}, 10}, {}, [](double, double) { return 0.0; }, effects);
  AddOutline(
      {ToEcef({1, 2, 3}), 0}, {}, [](double, double) { return 0.0; }, effects);
  EXPECT_TRUE(effects.empty());
}

}  // namespace
}  // namespace belvedere

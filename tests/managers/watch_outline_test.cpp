#include "managers/watch_outline.h"

#include "runtime/earth/ellipsoid.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

WatchOutlines::Areas Of(std::vector<WatchArea> areas) {
  return std::make_shared<const std::vector<WatchArea>>(std::move(areas));
}

TEST(WatchOutlinesTest, TheRimLiesOnTheGroundAtTheRadius) {
  for (const Geodetic& place : {Geodetic{46, 8, 500}, Geodetic{90, 0, 500}, Geodetic{-10, 180, 500}}) {
    const WatchArea area{ToEcef(place), 20'000};
    WatchOutlines outlines;
    std::vector<EffectInstance> effects;
    const glm::dvec3 eye = ToEcef({place.latitude_deg, place.longitude_deg, 1500});
    outlines.Add(
        Of({area}), eye, 0, [](double, double) { return 500.0; }, effects);
    ASSERT_EQ(effects.size(), kRimPieces);
    for (size_t i = 0; i < effects.size(); ++i) {
      EXPECT_NEAR(glm::distance(effects[i].from_ecef, area.centre_ecef), 20'000, 100);
      EXPECT_NEAR(ToGeodetic(effects[i].from_ecef).height_m, 560, 15);  // a little above, for the eye is 20 km away
      EXPECT_EQ(effects[i].to_ecef, effects[(i + 1) % effects.size()].from_ecef);
    }
  }
}

TEST(WatchOutlinesTest, TheGroundIsLookedUpForOtherAreasAndOnceASecond) {
  WatchOutlines outlines;
  std::vector<EffectInstance> effects;
  size_t looks = 0;
  const GroundHeight ground = [&](double, double) {
    ++looks;
    return 0.0;
  };
  const WatchOutlines::Areas areas = Of({{ToEcef({1, 2, 3}), 1000}});
  outlines.Add(areas, {}, 10.0, ground, effects);
  EXPECT_EQ(looks, kRimPieces);
  outlines.Add(areas, {}, 10.9, ground, effects);
  EXPECT_EQ(looks, kRimPieces);
  EXPECT_EQ(effects.size(), 2 * kRimPieces);
  outlines.Add(areas, {}, 11.1, ground, effects);
  EXPECT_EQ(looks, 2 * kRimPieces);
  outlines.Add(Of({{ToEcef({1, 2, 3}), 500}}), {}, 11.2, ground, effects);
  EXPECT_EQ(looks, 3 * kRimPieces);
}

TEST(WatchOutlinesTest, WithoutAreasNothingIsEverDue) {
  WatchOutlines outlines;
  std::vector<EffectInstance> effects;
  EXPECT_FALSE(outlines.AreDue(nullptr, 1e6));
  const WatchOutlines::Areas areas = Of({{ToEcef({1, 2, 3}), 1000}});
  outlines.Add(
      areas, {}, 5, [](double, double) { return 0.0; }, effects);
  EXPECT_FALSE(outlines.AreDue(areas, 5.5));
  EXPECT_TRUE(outlines.AreDue(areas, 7));
  EXPECT_TRUE(outlines.AreDue(nullptr, 5.5)) << "what was there goes";
  outlines.Add(
      nullptr, {}, 6, [](double, double) { return 0.0; }, effects);
  EXPECT_FALSE(outlines.AreDue(nullptr, 1e6));
}

TEST(WatchOutlinesTest, AnAreaOfNoSizeHasNoneAndTheirNumberHasABound) {
  WatchOutlines outlines;
  std::vector<EffectInstance> effects;
  const GroundHeight flat = [](double, double) { return 0.0; };
  outlines.Add(Of({{{}, 10}, {ToEcef({1, 2, 3}), 0}}), {}, 0, flat, effects);
  outlines.Add(nullptr, {}, 0, flat, effects);
  EXPECT_TRUE(effects.empty());
  outlines.Add(Of(std::vector<WatchArea>(100, {ToEcef({1, 2, 3}), 10})), {}, 0, flat, effects);
  EXPECT_EQ(effects.size(), kMostEffects);
}

}  // namespace
}  // namespace belvedere

#include "preproc/changed_extents.h"

#include "preproc/georeference.h"
#include "preproc/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace belvedere {
namespace {

SourceRecord Source(const std::string& settings, const std::string& state, double west_deg) {
  SourceRecord source;
  source.settings = settings;
  source.state = state;
  source.extent = {west_deg, 0, west_deg + 1, 1};
  return source;
}

std::vector<double> Wests(const std::vector<SourceRecord>& before, const std::vector<SourceRecord>& after) {
  std::vector<double> wests;
  for (const GeoBox& extent : ChangedExtents(before, after, [](size_t) { return false; }))
    wests.push_back(extent.west_deg);
  return wests;
}

TEST(ChangedExtents, AreOfSourcesThatComeGoOrChange) {
  const SourceRecord a = Source("a", "1", 10), b = Source("b", "1", 20), c = Source("c", "1", 30);
  EXPECT_TRUE(Wests({a, b, c}, {a, b, c}).empty());
  EXPECT_EQ(Wests({a, b}, {a, b, c}), std::vector<double>{30});
  EXPECT_EQ(Wests({a, b, c}, {a, c}), std::vector<double>{20});
  EXPECT_EQ(Wests({}, {a}), std::vector<double>{10});
  EXPECT_EQ(Wests({a, b, c}, {a, Source("b", "2", 21), c}), (std::vector<double>{20, 21}));
  EXPECT_EQ(Wests({a, b, c}, {a, Source("other b", "1", 20), c}), (std::vector<double>{20, 20}));
  EXPECT_EQ(Wests({a, b, c}, {b, a, c}), (std::vector<double>{10, 20, 20, 10}));
}

TEST(ChangedExtents, AreOfSourcesWhoseColoursAreFittedOtherwise) {
  const SourceRecord a = Source("a", "1", 10), b = Source("b", "1", 20);
  SourceRecord fitted = b, other = b;
  fitted.colour_fit.emplace();
  other.colour_fit.emplace();
  other.colour_fit->offset[1] = 3;
  EXPECT_TRUE(Wests({a, fitted}, {a, fitted}).empty());
  EXPECT_EQ(Wests({a, b}, {a, fitted}).size(), 2u);
  EXPECT_EQ(Wests({a, fitted}, {a, other}).size(), 2u);
}

TEST(ChangedExtents, VoidsOverWhatChangesChangeToo) {
  const SourceRecord below = Source("a", "1", 10), changed = Source("a", "2", 10);
  const SourceRecord over = Source("b", "1", 10.5), beside = Source("c", "1", 13), over_that = Source("d", "1", 11.2);
  const std::vector<SourceRecord> before = {below, over, beside, over_that};
  const std::vector<SourceRecord> after = {changed, over, beside, over_that};
  const auto count = [&](const std::set<size_t>& with_voids) {
    return ChangedExtents(before, after, [&](size_t place) { return with_voids.contains(place); }).size();
  };
  EXPECT_EQ(count({}), 2u);
  EXPECT_EQ(count({1}), 3u);
  EXPECT_EQ(count({2}), 2u) << "it lies elsewhere";
  EXPECT_EQ(count({3}), 2u) << "it meets only what has no voids";
  EXPECT_EQ(count({1, 3}), 4u) << "it meets one that changes for its voids";
  EXPECT_EQ(count({0}), 2u);
}

bool HoldsAPositionIn(const GeoBox& extent, LayerKind kind, Quadcode node) {
  for (const LatticeRows& rows : kind == LayerKind::kElevation ? PostLattice(node) : TexelLattice(node)) {
    for (const double latitude : rows.latitudes_deg) {
      if (std::any_of(rows.longitudes_deg.begin(), rows.longitudes_deg.end(),
                      [&](double longitude) { return Covers(extent, longitude, latitude); }))
        return true;
    }
  }
  return false;
}

TEST(ChangedExtents, TouchEveryPageThatHoldsAPositionInThem) {
  std::mt19937 random(2);
  const auto uniform = [&random](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
  };
  int held = 0, not_touched = 0;
  for (int i = 0; i < 300; ++i) {
    const auto level = static_cast<int>(random() % 5);
    const Quadcode near = Quadcode::Containing(i % 4 == 0 ? (i % 8 == 0 ? 89.9 : -89.9) : uniform(-90, 90),
                                               i % 3 == 0 ? 179.9 : uniform(-180, 180), level);
    const GeoBox box = near.Box();
    const double size = near.HeightDegrees();
    const double west = box.west_deg + uniform(-0.3, 1.2) * size, south = box.south_deg + uniform(-0.3, 1.2) * size;
    const GeoBox extent{west, std::max(south, -90.0), west + size / 10, std::min(south + size / 10, 90.0)};
    if (!(extent.south_deg < extent.north_deg)) continue;
    for (const LayerKind kind : {LayerKind::kElevation, LayerKind::kImagery}) {
      const bool touches = Touches(std::vector<GeoBox>{extent}, kind, near);
      not_touched += !touches;
      if (HoldsAPositionIn(extent, kind, near)) {
        ++held;
        EXPECT_TRUE(touches) << near.ToString();
      }
      if (touches && !near.is_root()) {
        EXPECT_TRUE(Touches(std::vector<GeoBox>{extent}, kind, near.Parent())) << near.ToString();
      }
    }
  }
  EXPECT_GT(held, 100);
  EXPECT_GT(not_touched, 50);
}

}  // namespace
}  // namespace belvedere

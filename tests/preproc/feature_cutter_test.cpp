// Pages of a vector layer: what is in them, and that together they are the features.
#include "preproc/vectors/feature_cutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace belvedere {
namespace {

using Pages = std::map<uint64_t, VectorPage>;

Pages Cut(const std::vector<Feature>& features) {
  Pages pages;
  const Status status = CutFeatures(features, [&](Quadcode node, const VectorPage& page) {
    EXPECT_TRUE(pages.emplace(node.word(), page).second) << node.ToString();
    return Status();
  });
  EXPECT_TRUE(status.ok());
  return pages;
}

Feature Line(uint32_t id, FeaturePart places) {
  Feature feature;
  feature.id = id;
  feature.of = FeatureClass::kRoad;
  feature.shape = FeatureShape::kLines;
  feature.resolution = 100;
  feature.parts = {std::move(places)};
  feature.attributes = {{"name", "road " + std::to_string(id)}, {"number", int64_t{id}}};
  return feature;
}

double LengthIn(const VectorPage& page) {
  double length = 0;
  for (const auto& part : page.parts) {
    for (uint32_t i = 1; i < part.points; ++i) {
      const VectorPoint a = page.points[part.first_point + i - 1], b = page.points[part.first_point + i];
      length += std::hypot(static_cast<double>(b.x) - a.x, static_cast<double>(b.y) - a.y);
    }
  }
  return length;
}

std::vector<Feature> Wanderers(int count, double reach_deg) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> longitude(-170, 170), latitude(-80, 80), step(-reach_deg, reach_deg);
  std::vector<Feature> features;
  for (int i = 0; i < count; ++i) {
    double x = longitude(random), y = latitude(random);
    FeaturePart line;
    for (int point = 0; point < 60; ++point) {
      line.push_back(GridPlace::At(y, x));
      x += step(random);
      y = std::clamp(y + step(random), -89.0, 89.0);
    }
    features.push_back(Line(static_cast<uint32_t>(i), line));
  }
  return features;
}

TEST(FeatureCutter, PagesAreAPyramidOfFours) {
  const Pages pages = Cut(Wanderers(40, 0.4));
  for (int tree = 0; tree < kTrees; ++tree) EXPECT_TRUE(pages.contains(Quadcode::Root(tree).word()));
  int complete = 0;
  for (const auto& [word, page] : pages) {
    const Quadcode node = *Quadcode::FromWord(word);
    for (const int which : node.Children())
      ASSERT_EQ(pages.contains(node.Child(which).word()), !page.is_complete) << node.ToString();
    complete += page.is_complete;
  }
  EXPECT_GT(complete, 100);
}

TEST(FeatureCutter, CompletePagesTogetherAreTheFeatures) {
  const std::vector<Feature> features = Wanderers(40, 0.4);
  double whole = 0, cut = 0;
  for (const Feature& feature : features) {
    const FeaturePart& part = feature.parts[0];
    for (size_t i = 1; i < part.size(); ++i)
      whole +=
          std::hypot(static_cast<double>(part[i].x - part[i - 1].x), static_cast<double>(part[i].y - part[i - 1].y));
  }
  for (const auto& [word, page] : Cut(features)) {
    if (page.is_complete) cut += LengthIn(page);
  }
  EXPECT_NEAR(cut / whole, 1, 1e-6);
}

// Also between quadtrees, and from one end of the Earth's grid to the other.
TEST(FeatureCutter, NeighboursShareThePointsOnTheirBorder) {
  std::vector<Feature> features = Wanderers(30, 2);
  features.push_back(Line(30, {GridPlace::At(10.1, 179.2), GridPlace::At(11.3, 181.7)}));
  features.push_back(Line(31, {GridPlace::At(-10.1, -181.2), GridPlace::At(-11.3, -178.7)}));
  const Pages pages = Cut(features);
  int shared = 0;
  for (const auto& [word, page] : pages) {
    const Quadcode node = *Quadcode::FromWord(word);
    const Quadcode east = Quadcode::FromColumnRow(node.level(), node.column() + 1, node.row());
    const auto other = pages.find(east.word());
    if (!page.is_complete || other == pages.end() || !other->second.is_complete) continue;
    std::multiset<int32_t> ours, theirs;
    for (const VectorPoint& point : page.points) {
      if (point.x == static_cast<int32_t>(node.GridWidth())) ours.insert(point.y);
    }
    for (const VectorPoint& point : other->second.points) {
      if (point.x == 0) theirs.insert(point.y);
    }
    ASSERT_EQ(ours, theirs) << node.ToString();
    shared += static_cast<int>(ours.size());
  }
  EXPECT_GT(shared, 20);
  const Quadcode last = Quadcode::Containing(10.1, 179.99, 0), first = Quadcode::Containing(10.1, -179.99, 0);
  EXPECT_FALSE(pages.at(last.word()).points.empty());
  EXPECT_FALSE(pages.at(first.word()).points.empty());
}

TEST(FeatureCutter, CoarsePagesHaveLittleAndTheImportantFirst) {
  std::vector<Feature> features;
  for (uint32_t i = 0; i < 20000; ++i) {
    Feature place;
    place.id = i;
    place.of = FeatureClass::kPlace;
    place.importance = static_cast<double>((i * 7919) % 20000);
    place.parts = {{GridPlace::At(46 + 0.0001 * (i / 141), 7 + 0.0001 * (i % 141))}};
    features.push_back(place);
  }
  const Pages pages = Cut(features);
  std::set<uint32_t> found;
  for (const auto& [word, page] : pages) {
    EXPECT_LE(page.points.size(), kMostPointsOfPage);
    for (size_t i = 1; i < page.features.size(); ++i)
      ASSERT_GT(features[page.features[i - 1].id].importance, features[page.features[i].id].importance);
    if (!page.is_complete) continue;
    for (const VectorFeature& feature : page.features) EXPECT_TRUE(found.insert(feature.id).second);
  }
  EXPECT_EQ(found.size(), features.size());
  const VectorPage& root = pages.at(Quadcode::Containing(46, 7, 0).word());
  EXPECT_EQ(root.features.size(), kMostPointsOfPage);
  EXPECT_EQ(features[root.features.front().id].importance, 19999);
}

TEST(FeatureCutter, SmallThingsAppearOnlyWhereTheyAreSeen) {
  int pages = 0;
  const std::vector<Feature> features{
      Line(0, {GridPlace::At(50.2, 10.2), GridPlace::At(50.201, 10.201), GridPlace::At(50.202, 10.2005)})};
  for (const auto& [word, page] : Cut(features)) {
    const Quadcode node = *Quadcode::FromWord(word);
    const bool is_seen = 0.002 >= node.HeightDegrees() / 2048;
    EXPECT_TRUE(is_seen || page.features.empty()) << node.ToString();
    pages += page.features.empty() ? 0 : 1;
  }
  EXPECT_GT(pages, 0);
}

TEST(FeatureCutter, BuildingsAreNeverCut) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> longitude(8, 8.2), latitude(47, 47.2);
  std::vector<Feature> features;
  for (uint32_t i = 0; i < 4000; ++i) {
    Feature house;
    house.id = i;
    house.of = FeatureClass::kBuilding;
    house.shape = FeatureShape::kPolygons;
    house.resolution = 100;
    const GridPlace corner = GridPlace::At(latitude(random), longitude(random));
    house.parts = {
        {corner, {corner.x + 1500, corner.y}, {corner.x + 1500, corner.y + 900}, {corner.x, corner.y + 900}}};
    features.push_back(house);
  }
  std::set<uint32_t> found;
  for (const auto& [word, page] : Cut(features)) {
    if (!page.is_complete) continue;
    const Quadcode node = *Quadcode::FromWord(word);
    for (const VectorFeature& house : page.features) {
      EXPECT_TRUE(found.insert(house.id).second);
      const VectorPage::Part& ring = page.parts[house.first_part];
      ASSERT_EQ(ring.points, 4u);
      const VectorPoint corner = page.points[ring.first_point], other = page.points[ring.first_point + 2];
      EXPECT_EQ(other.x - corner.x, 1500);
      EXPECT_EQ(other.y - corner.y, 900);
      const int64_t middle_x = corner.x + 750, middle_y = corner.y + 450, side = node.GridHeight();
      EXPECT_TRUE(middle_x >= 0 && middle_x < side && middle_y >= 0 && middle_y < side);
    }
  }
  EXPECT_EQ(found.size(), features.size());
}

TEST(FeatureCutter, AttributesGoWithEveryPiece) {
  const std::vector<Feature> features = Wanderers(5, 3);
  for (const auto& [word, page] : Cut(features)) {
    for (const VectorFeature& feature : page.features) {
      ASSERT_EQ(std::get<std::string>(*page.Find(feature, "name")), "road " + std::to_string(feature.id));
      ASSERT_EQ(std::get<int64_t>(*page.Find(feature, "number")), feature.id);
    }
  }
}

TEST(FeatureCutter, StopsWhereAPageCannotBeWritten) {
  int pages = 0;
  const Status status = CutFeatures(Wanderers(5, 1), [&](Quadcode, const VectorPage&) {
    return ++pages < 5 ? Status() : Status::Error("the disk is full");
  });
  EXPECT_EQ(status.message(), "the disk is full");
  EXPECT_EQ(pages, 5);
}

}  // namespace
}  // namespace belvedere

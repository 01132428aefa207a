// Pages of features and of buildings: what is encoded comes back, and what is damaged is refused.
#include "runtime/paging/vector_codec.h"

#include "runtime/paging/page_envelope.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace belvedere {
namespace {

VectorPage SomeFeatures() {
  VectorPage page;
  page.is_complete = true;
  page.features = {{7, FeatureClass::kRoad, FeatureShape::kLines, 0, 2, 0, 2},
                   {3, FeatureClass::kPlace, FeatureShape::kPoints, 2, 1, 2, 1},
                   {900, FeatureClass::kBuilding, FeatureShape::kPolygons, 3, 1, 3, 0}};
  page.parts = {{0, 2}, {2, 3}, {5, 1}, {6, 3}};
  page.points = {{0, 5}, {1 << 29, -4}, {3, 3}, {9, 9}, {12, 1}, {-1, 77}, {1, 1}, {5, 1}, {5, 6}};
  page.attributes = {{0, 0}, {1, 1}, {0, 2}};
  page.keys = {"name", "lanes"};
  page.values = {std::string("Höhenstraße"), int64_t{-2}, 0.25};
  return page;
}

BuildingPage SomeBuildings() {
  BuildingPage page;
  page.buildings = {{12, {4000000000u, 7u}, 12.5f, 20.25f}, {4, {1u, kGridNorthPole}, 3.0f, 1.5f}};
  page.vertices = {{1.25f, -2.5f, 0, {127, 0, -127}, {1, 2, 3}, 0},
                   {4.0f, 2.0f, 12.5f, {0, 0, 127}, {255, 0, 9}, 0},
                   {-4.0f, 2.0f, 3.0f, {0, 0, 127}, {255, 0, 9}, 1}};
  page.indices = {0, 1, 2, 2, 1, 0};
  page.details = {{0, 3, 0}, {3, 3, 1.5f}};
  return page;
}

TEST(VectorCodec, FeaturesComeBack) {
  const VectorPage page = SomeFeatures();
  const auto back = DecodeVector(EncodeVector(page));
  ASSERT_TRUE(back.ok()) << back.message();
  EXPECT_TRUE((*back)->is_complete);
  ASSERT_EQ((*back)->features.size(), 3u);
  EXPECT_EQ((*back)->points, page.points);
  EXPECT_EQ((*back)->keys, page.keys);
  EXPECT_EQ((*back)->values, page.values);
  const VectorFeature& road = (*back)->features[0];
  EXPECT_EQ(road.id, 7u);
  EXPECT_EQ(road.of, FeatureClass::kRoad);
  EXPECT_EQ(road.shape, FeatureShape::kLines);
  EXPECT_EQ((*back)->parts[road.first_part + 1].points, 3u);
  EXPECT_EQ(std::get<std::string>(*(*back)->Find(road, "name")), "Höhenstraße");
  EXPECT_EQ(std::get<int64_t>(*(*back)->Find(road, "lanes")), -2);
  EXPECT_EQ(std::get<double>(*(*back)->Find((*back)->features[1], "name")), 0.25);
  EXPECT_EQ((*back)->Find((*back)->features[2], "name"), nullptr);
  EXPECT_EQ((*back)->features[2].first_part, 3u);
  EXPECT_GT((*back)->bytes(), sizeof(VectorPage));
}

TEST(VectorCodec, BuildingsComeBack) {
  const BuildingPage page = SomeBuildings();
  const auto back = DecodeBuildings(EncodeBuildings(page));
  ASSERT_TRUE(back.ok()) << back.message();
  EXPECT_EQ((*back)->buildings[0].anchor, page.buildings[0].anchor);
  EXPECT_EQ((*back)->buildings[1].anchor, page.buildings[1].anchor);
  EXPECT_EQ((*back)->buildings[0].feature, 12u);
  EXPECT_FLOAT_EQ((*back)->buildings[0].radius_m, 20.25f);
  EXPECT_EQ((*back)->indices, page.indices);
  ASSERT_EQ((*back)->vertices.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR((*back)->vertices[i].east_m, page.vertices[i].east_m, 0.0051);
    EXPECT_NEAR((*back)->vertices[i].up_m, page.vertices[i].up_m, 0.0051);
    EXPECT_EQ((*back)->vertices[i].normal, page.vertices[i].normal);
    EXPECT_EQ((*back)->vertices[i].colour, page.vertices[i].colour);
    EXPECT_EQ((*back)->vertices[i].building, page.vertices[i].building);
  }
  EXPECT_EQ((*back)->details[1].first_index, 3u);
  EXPECT_FLOAT_EQ((*back)->details[1].error_m, 1.5f);
}

TEST(VectorCodec, EmptyPagesComeBack) {
  const auto features = DecodeVector(EncodeVector({}));
  ASSERT_TRUE(features.ok());
  EXPECT_TRUE((*features)->features.empty());
  EXPECT_FALSE((*features)->is_complete);
  ASSERT_TRUE(DecodeBuildings(EncodeBuildings({})).ok());
}

// Raw bytes with good checksums: damage that only the decoder can see. It must refuse, or give a page all of whose
// places are there.
template <typename Decode, typename Check>
void ExpectSafe(std::vector<uint8_t> raw, uint8_t kind, const Decode& decode, const Check& check) {
  std::mt19937 random(5);
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<uint8_t> bad = raw;
    if (i % 4 == 0) bad.resize(random() % bad.size());
    for (int changes = 0; changes < 1 + i % 3 && !bad.empty(); ++changes)
      bad[random() % bad.size()] = static_cast<uint8_t>(random());
    const auto page = decode(WrapPage(kind, 0, bad, 1));
    if (page.ok())
      check(**page);
    else
      ++refused;
  }
  EXPECT_GT(refused, 2000);
}

std::vector<uint8_t> RawOf(const std::vector<uint8_t>& bytes) {
  const auto raw = UnwrapPage(bytes, RawBytesOf(bytes));
  return {raw->begin(), raw->end()};
}

TEST(VectorCodec, DamagedFeaturesAreRefusedOrWhole) {
  ExpectSafe(RawOf(EncodeVector(SomeFeatures())), 5, DecodeVector, [](const VectorPage& page) {
    for (const VectorFeature& feature : page.features) {
      ASSERT_LE(size_t{feature.first_part} + feature.parts, page.parts.size());
      ASSERT_LE(size_t{feature.first_attribute} + feature.attributes, page.attributes.size());
      ASSERT_LT(static_cast<int>(feature.of), kFeatureClasses);
      static_cast<void>(page.Find(feature, "name"));
    }
    for (const VectorPage::Part& part : page.parts)
      ASSERT_LE(size_t{part.first_point} + part.points, page.points.size());
    for (const auto& use : page.attributes) ASSERT_TRUE(use.key < page.keys.size() && use.value < page.values.size());
  });
}

TEST(VectorCodec, DamagedBuildingsAreRefusedOrWhole) {
  ExpectSafe(RawOf(EncodeBuildings(SomeBuildings())), 6, DecodeBuildings, [](const BuildingPage& page) {
    for (const uint32_t index : page.indices) ASSERT_LT(index, page.vertices.size());
    for (const BuildingVertex& vertex : page.vertices) ASSERT_LT(vertex.building, page.buildings.size());
    for (const auto& detail : page.details) ASSERT_LE(size_t{detail.first_index} + detail.indices, page.indices.size());
  });
}

TEST(VectorCodec, AFlippedBitShows) {
  std::vector<uint8_t> bytes = EncodeVector(SomeFeatures());
  bytes[bytes.size() / 2] ^= 4;
  EXPECT_FALSE(DecodeVector(bytes).ok());
  EXPECT_FALSE(DecodeBuildings(EncodeVector(SomeFeatures())).ok()) << "of another kind";
}

}  // namespace
}  // namespace belvedere

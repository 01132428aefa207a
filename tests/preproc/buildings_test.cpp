// Models of buildings: their volume, that their walls and roofs close, and what their attributes make of them.
#include "preproc/vectors/buildings.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

using Outline = std::vector<std::vector<VectorPoint>>;

const Quadcode kNode = Quadcode::Containing(0.001, 10.001, 12);
// Grid units a metre at the equator, a little less to the north than to the east.
const double kEast = 1 / (111319.49 * 45 / (1 << 29)), kNorth = 1 / (110574.3 * 45 / (1 << 29));

std::vector<VectorPoint> Ring(const std::vector<std::pair<double, double>>& metres) {
  std::vector<VectorPoint> ring;
  for (const auto& [east, north] : metres)
    ring.push_back({static_cast<int32_t>(std::lrint(east * kEast)) + 20000,
                    static_cast<int32_t>(std::lrint(north * kNorth)) + 20000});
  return ring;
}

VectorPage PageOf(const Outline& outline, const std::vector<Attribute>& attributes) {
  VectorPage page;
  VectorFeature house;
  house.id = 5;
  house.of = FeatureClass::kBuilding;
  house.shape = FeatureShape::kPolygons;
  house.parts = static_cast<uint32_t>(outline.size());
  house.attributes = static_cast<uint32_t>(attributes.size());
  page.features.push_back(house);
  for (const auto& ring : outline) {
    page.parts.push_back({static_cast<uint32_t>(page.points.size()), static_cast<uint32_t>(ring.size())});
    page.points.insert(page.points.end(), ring.begin(), ring.end());
  }
  for (const auto& [key, value] : attributes) {
    page.attributes.push_back({static_cast<uint32_t>(page.keys.size()), static_cast<uint32_t>(page.values.size())});
    page.keys.push_back(key);
    page.values.push_back(value);
  }
  return page;
}

std::vector<std::array<glm::dvec3, 3>> TrianglesOf(const BuildingPage& page, size_t detail) {
  std::vector<std::array<glm::dvec3, 3>> triangles;
  const auto& range = page.details[detail];
  for (uint32_t i = range.first_index; i < range.first_index + range.indices; i += 3) {
    std::array<glm::dvec3, 3> corners;
    for (uint32_t k = 0; k < 3; ++k) {
      const BuildingVertex& vertex = page.vertices[page.indices[i + k]];
      corners[k] = {vertex.east_m, vertex.north_m, vertex.up_m};
    }
    triangles.push_back(corners);
  }
  return triangles;
}

// Over the ground: what is open below stands on it.
double VolumeOf(const BuildingPage& page, size_t detail) {
  double volume = 0;
  for (const auto& [a, b, c] : TrianglesOf(page, detail)) volume += glm::dot(a, glm::cross(b, c)) / 6;
  return volume;
}

// Every edge is met by another the other way round, but those on the ground.
void ExpectClosed(const BuildingPage& page, size_t detail) {
  std::vector<glm::dvec3> corners;
  const auto corner = [&corners](const glm::dvec3& place) {
    for (size_t i = 0; i < corners.size(); ++i) {
      if (glm::distance(corners[i], place) < 0.005) return i;
    }
    corners.push_back(place);
    return corners.size() - 1;
  };
  std::map<std::pair<size_t, size_t>, int> edges;
  for (const auto& triangle : TrianglesOf(page, detail)) {
    for (size_t k = 0; k < 3; ++k) {
      const glm::dvec3 a = triangle[k], b = triangle[(k + 1) % 3];
      if (a.z < 1e-6 && b.z < 1e-6) continue;
      const size_t from = corner(a), to = corner(b);
      if (from == to) continue;
      ++edges[{from, to}];
      --edges[{to, from}];
    }
  }
  for (const auto& [edge, count] : edges) ASSERT_EQ(count, 0);
}

const Outline kBox{Ring({{0, 0}, {20, 0}, {20, 10}, {0, 10}})};
const Outline kL{Ring({{0, 0}, {30, 0}, {30, 12}, {14, 12}, {14, 25}, {0, 25}})};

TEST(Buildings, ABoxIsAsLargeAsItIs) {
  const auto page = RaiseBuildings(PageOf(kBox, {{"height", 9.0}}), kNode);
  ASSERT_EQ(page->buildings.size(), 1u);
  EXPECT_EQ(page->buildings[0].feature, 5u);
  EXPECT_FLOAT_EQ(page->buildings[0].height_m, 9);
  EXPECT_NEAR(page->buildings[0].radius_m, std::hypot(10, 5), 0.02);
  ASSERT_EQ(page->details.size(), 3u);
  for (size_t detail = 0; detail < 3; ++detail) {
    EXPECT_NEAR(VolumeOf(*page, detail), 20 * 10 * 9, 4);
    ExpectClosed(*page, detail);
    EXPECT_NEAR(page->details[detail].error_m, 0, 0.02);
  }
  const GeoBox box = kNode.Box();
  EXPECT_GT(page->buildings[0].anchor.latitude_deg(), box.south_deg);
  EXPECT_LT(page->buildings[0].anchor.longitude_deg(), box.east_deg);
}

TEST(Buildings, EveryRoofClosesAndHasItsVolume) {
  const std::map<std::string, double> shares{
      {"flat", 1}, {"skillion", 0.5}, {"gabled", 0.5}, {"hipped", 0.5 - 1.0 / 12}, {"pyramidal", 1.0 / 3}};
  for (const auto& [shape, share] : shares) {
    const auto page = RaiseBuildings(
        PageOf(kBox, {{"height", std::string("10 m")}, {"roof:shape", shape}, {"roof:height", std::string("4")}}),
        kNode);
    const double eaves = shape == "flat" ? 10 : 6, rise = 10 - eaves;
    EXPECT_NEAR(VolumeOf(*page, 0), 200 * (eaves + share * rise), 5) << shape;
    ExpectClosed(*page, 0);
    EXPECT_NEAR(page->details[1].error_m, rise / 2, 0.02) << shape;
  }
}

TEST(Buildings, RoofsCloseOverCornersAndCourts) {
  const Outline court{Ring({{0, 0}, {40, 0}, {40, 30}, {0, 30}}), Ring({{10, 10}, {30, 10}, {30, 20}, {10, 20}})};
  for (const char* shape : {"flat", "skillion", "gabled", "hipped", "pyramidal"}) {
    for (const Outline& outline : {kL, court}) {
      const auto page =
          RaiseBuildings(PageOf(outline, {{"height", int64_t{12}}, {"roof:shape", std::string(shape)}}), kNode);
      ASSERT_EQ(page->buildings.size(), 1u);
      ExpectClosed(*page, 0);
      ExpectClosed(*page, 1);
    }
  }
  const auto page = RaiseBuildings(PageOf(court, {{"height", int64_t{12}}}), kNode);
  EXPECT_NEAR(VolumeOf(*page, 0), (1200 - 200) * 12, 30);
  EXPECT_NEAR(VolumeOf(*page, 2), 1200 * 12, 30) << "the box alone";
}

TEST(Buildings, HeightsComeFromWhatIsKnown) {
  const auto height = [](const std::vector<Attribute>& attributes) {
    return RaiseBuildings(PageOf(kBox, attributes), kNode)->buildings.at(0).height_m;
  };
  EXPECT_FLOAT_EQ(height({}), 6);
  EXPECT_FLOAT_EQ(height({{"building:levels", std::string("4")}}), 12);
  EXPECT_FLOAT_EQ(height({{"height", std::string("100 ft")}}), 30.48f);
  EXPECT_FLOAT_EQ(height({{"height", std::string("40'")}}), 12.192f);
  EXPECT_FLOAT_EQ(height({{"height", std::string("tall")}}), 6);
  EXPECT_FLOAT_EQ(height({{"height", std::string("-3")}}), 6);
  EXPECT_FLOAT_EQ(height({{"height", 1e9}}), 6);
}

TEST(Buildings, AFloorAboveTheGroundStaysThere) {
  const auto page = RaiseBuildings(PageOf(kBox, {{"height", 9.0}, {"min_height", 5.0}}), kNode);
  for (const BuildingVertex& vertex : page->vertices) EXPECT_GE(vertex.up_m, 5);
}

TEST(Buildings, ColoursAreThoseOfTheTags) {
  const auto page = RaiseBuildings(
      PageOf(kBox, {{"building:colour", std::string("#102030")}, {"roof:colour", std::string("red")}}), kNode);
  for (const BuildingVertex& vertex : page->vertices) {
    const bool is_top = vertex.normal[2] > 60;
    EXPECT_EQ(vertex.colour, (is_top ? std::array<uint8_t, 3>{255, 0, 0} : std::array<uint8_t, 3>{16, 32, 48}));
  }
  EXPECT_EQ(ParseColourName("#8f4"), (std::array<uint8_t, 3>{0x88, 0xff, 0x44}));
  for (const char* bad : {"", "#12", "#12345g", "blau", "#1234567"}) EXPECT_FALSE(ParseColourName(bad)) << bad;
}

TEST(Buildings, BadOutlinesMakeNoHarm) {
  const Outline bow{Ring({{0, 0}, {20, 10}, {20, 0}, {0, 10}})};
  const auto page = RaiseBuildings(PageOf(bow, {{"height", 5.0}}), kNode);
  ASSERT_EQ(page->buildings.size(), 1u);
  EXPECT_NEAR(VolumeOf(*page, 0), 100 * 5, 4) << "its two triangles";
  for (const Outline& none :
       {Outline{Ring({{0, 0}, {9, 0}, {18, 0}})}, Outline{Ring({{3, 3}, {3, 3}, {3, 3}})}, Outline{}}) {
    const auto empty = RaiseBuildings(PageOf(none, {}), kNode);
    EXPECT_TRUE(empty->buildings.empty());
    EXPECT_TRUE(empty->details.empty());
  }
}

}  // namespace
}  // namespace belvedere

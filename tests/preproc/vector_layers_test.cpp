// Vector layers in a dataset: built, asked, changed, and what is said of what is wrong with them.
#include "preproc/vectors/feature_index.h"
#include "runtime/paging/building_page.h"
#include "runtime/paging/vector_page.h"
#include "tests/preproc/changed_dataset.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;
using nlohmann::json;

// A hundred places along a line of latitude, "place 0" at 10 E, a degree apart over 180 E.
void WritePlaces(const std::string& path, int count, const std::string& name) {
  std::string text = "lon,lat,name,people\n";
  for (int i = 0; i < count; ++i) {
    const int longitude = 100 + i;
    text += fmt::format("{},{},{} {},{}\n", longitude > 180 ? longitude - 360 : longitude, 20, name, i, 1000 + i);
  }
  std::ofstream(path) << text;
}

std::string Prepare(const std::string& name) {
  const std::string folder = FreshFolder(name);
  Noise(folder + "/world.tif", 1, 64, 32, Degrees(-180, 90, 360.0 / 64), 1, 40);
  WritePlaces(folder + "/places.csv", 100, "Place");
  WritePlaces(folder + "/others.csv", 3, "Other");
  std::ofstream(folder + "/houses.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"height":"9","name":"House"},)"
      << R"("geometry":{"type":"Polygon","coordinates":[[[9,47],[9.0003,47],[9.0003,47.0001],[9,47.0001],[9,47]]]}}]})";
  return folder;
}

const std::string kHeights = Layer("elevation", {"path = \"world.tif\""});
const std::string kPlaces =
    "[[layer]]\nname = \"places\"\nkind = \"vector\"\n[[layer.source]]\npath = \"places.csv\"\nfeatures = \"place\"\n"
    "importance = \"people\"\n";
const std::string kOthers =
    "[[layer]]\nname = \"places\"\nkind = \"vector\"\n[[layer.source]]\npath = \"others.csv\"\nfeatures = \"place\"\n";
const std::string kHouses =
    "[[layer]]\nname = \"houses\"\nkind = \"vector\"\n[[layer.source]]\npath = \"houses.geojson\"\nfeatures = "
    "\"building\"\n[[layer]]\nname = \"town\"\nkind = \"buildings\"\nof = \"houses\"\n";

std::vector<json> Ask(const std::string& folder, const FeatureQuery& query) {
  std::vector<json> answers;
  const auto dataset = MustOpen(folder);
  const auto count =
      QueryFeatures(*dataset, query, [&](const std::string& line) { answers.push_back(json::parse(line)); });
  EXPECT_TRUE(count.ok()) << count.message();
  EXPECT_EQ(*count, static_cast<int64_t>(answers.size()));
  return answers;
}
std::string NameOfAnswer(const json& answer) {
  return answer.at("properties").value("name", "");
}

TEST(VectorLayers, AreBuiltWithTheirIndex) {
  const std::string folder = Prepare("vectors_built");
  const BuildReport report = MustBuild(folder, kHeights + kPlaces + kHouses);
  EXPECT_TRUE(report.warnings.empty());
  const auto dataset = MustOpen(folder);
  EXPECT_TRUE(VerifyDataset(*dataset).problems.empty());
  ASSERT_EQ(dataset->layers().size(), 4u);
  EXPECT_EQ(dataset->layers()[1].kind, LayerKind::kVector);
  EXPECT_EQ(dataset->layers()[3].kind, LayerKind::kModel);
  EXPECT_EQ(dataset->layers()[1].sources[0].crs, "EPSG:4326");
  EXPECT_TRUE(fs::exists(dataset->features_path()));
  EXPECT_EQ(json::parse(DescribeDatasetJson(*dataset)).at("features"), dataset->features_path());
  const Quadcode node = dataset->FinestContaining(2, 47.00005, 9.0001);
  const auto houses = dataset->ReadVector(2, node);
  const auto models = dataset->ReadBuildings(3, node);
  ASSERT_TRUE(houses.ok() && models.ok());
  ASSERT_EQ((*models)->buildings.size(), 1u);
  EXPECT_EQ((*models)->buildings[0].feature, (*houses)->features[0].id);
  EXPECT_FLOAT_EQ((*models)->buildings[0].height_m, 9);
}

TEST(VectorLayers, AnswerQuestions) {
  const std::string folder = Prepare("vectors_asked");
  MustBuild(folder, kHeights + kPlaces + kHouses);
  EXPECT_EQ(Ask(folder, {.limit = 1000}).size(), 101u);
  const auto first = Ask(folder, {.limit = 2});
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(NameOfAnswer(first[0]), "Place 99") << "the most important first";
  const auto named = Ask(folder, {.name = "pLACE 7", .limit = 100});
  EXPECT_EQ(named.size(), 11u) << "7, and 70 to 79";
  const auto houses = Ask(folder, {.layer = "houses"});
  ASSERT_EQ(houses.size(), 1u);
  EXPECT_EQ(houses[0].at("geometry").at("type"), "Polygon");
  EXPECT_EQ(houses[0].at("properties").at("class"), "building");
  EXPECT_EQ(Ask(folder, {.of = FeatureClass::kBuilding}).size(), 1u);
  EXPECT_EQ(Ask(folder, {.box = GeoBox{99.5, 19, 102.5, 21}}).size(), 3u);
  EXPECT_EQ(Ask(folder, {.box = GeoBox{178.5, 19, 181.5, 21}}).size(), 3u) << "over 180 E";
  EXPECT_EQ(Ask(folder, {.where = "json_extract(attributes, '$.people') < 1005"}).size(), 5u);
}

TEST(VectorLayers, FindTheNearest) {
  const std::string folder = Prepare("vectors_near");
  MustBuild(folder, kHeights + kPlaces);
  // A degree of longitude at 20 N is 104.6 km.
  const auto near = Ask(folder, {.near = FeatureQuery::Near{20, 110.2, 120000}});
  ASSERT_EQ(near.size(), 2u);
  EXPECT_EQ(NameOfAnswer(near[0]), "Place 10");
  EXPECT_NEAR(near[0].at("properties").at("distance_m").get<double>(), 0.2 * 104647, 60);
  EXPECT_NEAR(near[1].at("properties").at("distance_m").get<double>(), 0.8 * 104647, 240);
  const auto over = Ask(folder, {.near = FeatureQuery::Near{20, -179.9, 120000}});
  ASSERT_EQ(over.size(), 3u);
  EXPECT_EQ(NameOfAnswer(over[0]), "Place 80") << "at 180 E";
  EXPECT_EQ(NameOfAnswer(over[1]), "Place 81");
}

TEST(VectorLayers, QuestionsThatCannotBeAskedAreRefused) {
  const std::string folder = Prepare("vectors_refused");
  MustBuild(folder, kHeights + kPlaces);
  const auto dataset = MustOpen(folder);
  const auto reason = [&](const FeatureQuery& query) {
    const auto count = QueryFeatures(*dataset, query, [](const std::string&) {});
    return count.ok() ? "it was answered" : count.message();
  };
  EXPECT_NE(reason({.layer = "roads"}).find("no vector layer roads"), std::string::npos);
  EXPECT_NE(reason({.where = "size = 3"}).find("no such column: size"), std::string::npos);
  EXPECT_EQ(Ask(folder, {.name = "it's \"quoted\""}).size(), 0u);
  fs::remove(dataset->features_path());
  EXPECT_NE(reason({}).find("cannot be read"), std::string::npos);
}

TEST(VectorLayers, ChangeWithTheirSources) {
  const std::string folder = Prepare("vectors_changed");
  MustBuild(folder, kHeights + kPlaces + kHouses);
  const Pages before = PagesOf(folder);
  const std::string index = MustOpen(folder)->features_path();
  const auto added = Add(folder, kOthers);
  ASSERT_TRUE(added.ok()) << added.message();
  EXPECT_EQ(Ask(folder, {.name = "Other"}).size(), 3u);
  EXPECT_EQ(added->written, CountNew(before, PagesOf(folder))) << "only what differs is written";
  EXPECT_LT(added->written, 4);
  EXPECT_FALSE(fs::exists(index)) << "the index before is gone";
  ASSERT_TRUE(Remove(folder, "others.csv").ok());
  ExpectSame(PagesOf(folder), before);
  EXPECT_EQ(Ask(folder, {.name = "Other"}).size(), 0u);
  WritePlaces(folder + "/places.csv", 40, "Renamed");
  ASSERT_TRUE(Refresh(folder).ok());
  EXPECT_EQ(Ask(folder, {.name = "Renamed"}).size(), 40u);
  EXPECT_EQ(Ask(folder, {.layer = "houses"}).size(), 1u) << "the other layers are in the new index too";
  ExpectSame(PagesOf(folder), BuiltWhole("vectors_whole", folder, kHeights + kPlaces + kHouses));
}

TEST(VectorLayers, WhatIsLeftOutIsSaidOnceItComes) {
  const std::string folder = Prepare("vectors_remarks");
  MustBuild(folder, kHeights + kPlaces);
  std::ofstream(folder + "/others.csv") << "lon,lat,name\n5,5,Here\n5,500,Nowhere\n";
  const auto added = Add(folder, kOthers);
  ASSERT_TRUE(added.ok()) << added.message();
  ASSERT_EQ(added->warnings.size(), 1u);
  EXPECT_EQ(added->warnings[0].reason, "1 features have no place on the Earth and are left out");
  const auto again = Add(folder, kHouses);
  ASSERT_TRUE(again.ok()) << again.message();
  EXPECT_TRUE(again->warnings.empty());
}

TEST(VectorLayers, StayWhereOthersChange) {
  const std::string folder = Prepare("vectors_stay");
  MustBuild(folder, kHeights + kPlaces + kHouses);
  Noise(folder + "/inset.tif", 2, 40, 30, Degrees(11.2, 47.9, 0.01));
  const std::string index = MustOpen(folder)->features_path();
  const auto added = Add(folder, Layer("elevation", {"path = \"inset.tif\""}));
  ASSERT_TRUE(added.ok()) << added.message();
  EXPECT_EQ(MustOpen(folder)->features_path(), index);
  EXPECT_EQ(Ask(folder, {.limit = 1000}).size(), 101u);
  EXPECT_TRUE(VerifyDataset(*MustOpen(folder)).problems.empty());
}

TEST(VectorLayers, ComeToADatasetThatHasNone) {
  const std::string folder = Prepare("vectors_added");
  MustBuild(folder, kHeights);
  EXPECT_EQ(MustOpen(folder)->features_path(), "");
  const auto added = Add(folder, kPlaces + kHouses);
  ASSERT_TRUE(added.ok()) << added.message();
  EXPECT_EQ(Ask(folder, {.limit = 1000}).size(), 101u);
  ExpectSame(PagesOf(folder), BuiltWhole("vectors_whole2", folder, kHeights + kPlaces + kHouses));
}

TEST(VectorLayers, ASourceThatCannotBeReadIsLeftOut) {
  const std::string folder = Prepare("vectors_skipped");
  const std::string spec = kHeights + kPlaces + "[[layer.source]]\npath = \"gone.shp\"\nfeatures = \"place\"\n";
  const BuildReport report = MustBuild(folder, spec);
  ASSERT_EQ(report.skipped.size(), 1u);
  EXPECT_EQ(report.skipped[0].source, "gone.shp");
  EXPECT_EQ(Ask(folder, {.limit = 1000}).size(), 100u);
}

// A plane of 9 m posts that rises to the east, noise on it, and a road from south to north.
std::string PrepareRoad(const std::string& name) {
  const std::string folder = Prepare(name);
  std::mt19937 random(3);
  Write(folder + "/fine.tif",
        {.width = 160, .height = 160, .affine = Degrees(20, 10.0128, 0.00008), .value = [&](int, int column, int) {
           return 300 + 0.5 * column + static_cast<double>(random() % 400) / 100;
         }});
  std::ofstream(folder + "/road.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
      << R"({"type":"LineString","coordinates":[[20.0063,10.001],[20.0063,10.012]]}}]})";
  return folder;
}
const std::string kFine = Layer("elevation", {"path = \"world.tif\"", "path = \"fine.tif\"\ndatum = \"ellipsoid\""});
const std::string kRoad =
    "[[layer]]\nname = \"roads\"\nkind = \"vector\"\n[[layer.source]]\npath = \"road.geojson\"\nfeatures = \"road\"\n"
    "corrects = \"elevation\"\nwidth_m = 60\n";

double HeightAt(const Dataset& dataset, double latitude_deg, double longitude_deg) {
  const Quadcode node = dataset.FinestContaining(0, latitude_deg, longitude_deg);
  return BilinearHeight(**dataset.ReadElevation(0, node), node, latitude_deg, longitude_deg);
}
// The most that the ground differs across the road.
double Tilt(const Dataset& dataset) {
  double most_m = 0;
  for (double latitude_deg = 10.002; latitude_deg < 10.011; latitude_deg += 0.0003)
    most_m = std::max(most_m, std::abs(HeightAt(dataset, latitude_deg, 20.0063 - 0.00017) -
                                       HeightAt(dataset, latitude_deg, 20.0063 + 0.00017)));
  return most_m;
}

TEST(VectorLayers, CorrectTheGroundWhereTheyAskForIt) {
  const std::string folder = PrepareRoad("vectors_road");
  MustBuild(folder, kFine);
  const double tilt_m = Tilt(*MustOpen(folder));
  EXPECT_GT(tilt_m, 2);
  const double away_m = HeightAt(*MustOpen(folder), 10.005, 20.003);
  MustBuild(folder, kFine + kRoad);
  const auto dataset = MustOpen(folder);
  EXPECT_LT(Tilt(*dataset), 0.25);
  EXPECT_EQ(HeightAt(*dataset, 10.005, 20.003), away_m);
  EXPECT_TRUE(VerifyDataset(*dataset).problems.empty());
}

TEST(VectorLayers, TheGroundFollowsItsRoads) {
  const std::string folder = PrepareRoad("vectors_road_changed");
  MustBuild(folder, kFine + Layer("imagery", {"path = \"world.tif\""}));
  const auto added = Add(folder, kRoad);
  ASSERT_TRUE(added.ok()) << added.message();
  const std::string whole = kFine + Layer("imagery", {"path = \"world.tif\""}) + kRoad;
  ExpectSame(PagesOf(folder), BuiltWhole("vectors_road_whole", folder, whole));
  // The ground under one end of the road alone.
  Noise(folder + "/patch.tif", 9, 20, 20, Degrees(20.0058, 10.0123, 0.00006));
  const std::string patched = "path = \"patch.tif\"\ndatum = \"ellipsoid\"";
  ASSERT_TRUE(Add(folder, Layer("elevation", {patched})).ok());
  ExpectSame(
      PagesOf(folder),
      BuiltWhole("vectors_road_whole", folder,
                 Layer("elevation", {"path = \"world.tif\"", "path = \"fine.tif\"\ndatum = \"ellipsoid\"", patched}) +
                     Layer("imagery", {"path = \"world.tif\""}) + kRoad));
  std::ofstream(folder + "/road.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
      << R"({"type":"LineString","coordinates":[[20.002,10.004],[20.011,10.006]]}}]})";
  ASSERT_TRUE(Refresh(folder).ok());
  ExpectSame(
      PagesOf(folder),
      BuiltWhole("vectors_road_whole", folder,
                 Layer("elevation", {"path = \"world.tif\"", "path = \"fine.tif\"\ndatum = \"ellipsoid\"", patched}) +
                     Layer("imagery", {"path = \"world.tif\""}) + kRoad));
}

TEST(VectorLayers, ACorrectionWithoutItsLayerIsSaid) {
  const std::string folder = PrepareRoad("vectors_road_homeless");
  std::string road = kRoad;
  road.replace(road.find("\"elevation\""), 11, "\"ground\"");
  const BuildReport report = MustBuild(folder, kFine + road);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].reason, "there is no elevation layer ground that it could correct");
}

TEST(VectorLayers, MistakesInTheSpecAreNamed) {
  const std::string layer = "[[layer]]\nname = \"v\"\nkind = \"vector\"\n";
  const std::string source = layer + "[[layer.source]]\npath = \"a.csv\"\n";
  const auto reason = [](const std::string& text) {
    const auto spec = ParseSpec(text, "spec.toml");
    return spec.ok() ? "it was taken" : spec.message();
  };
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {source, "\"features\""},
           {source + "features = \"lake\"\n", ":6: \"features\" must be one of \"other\", \"road\""},
           {source + "features = \"road\"\nresolution_m = 0\n", ":7: \"resolution_m\" must be more than 0"},
           {source + "features = \"road\"\nwidth_m = 5\n", "one needs the other"},
           {source + "features = \"road\"\ncorrects = \"elevation\"\n", "one needs the other"},
           {source + "features = \"road\"\ncorrects = \"elevation\"\nwidth_m = 0\n",
            ":8: \"width_m\" must be more than 0"},
           {source + "features = \"road\"\nfields = 3\n", ":7: \"fields\" must name some"},
           {source + "features = \"road\"\nfields = { name = 4 }\n", "\"name\" must be the name of a field"},
           {source + "features = \"road\"\nnodata = 3\n", "nodata"},
           {layer + "priority = \"order\"\n", ":4: \"priority\" means nothing for vectors"},
           {layer, "has no source"},
           {"[[layer]]\nname = \"t\"\nkind = \"buildings\"\n", "\"t\" is made of a layer of type \"vector\""}}) {
    EXPECT_NE(reason(text).find(said), std::string::npos) << text << reason(text);
  }
}

}  // namespace
}  // namespace belvedere

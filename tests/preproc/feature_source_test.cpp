// Files of features: what is read of them, and what is refused and why.
#include "preproc/vectors/feature_source.h"

#include "tests/preproc/made_raster.h"

#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <utility>

namespace belvedere {
namespace {

using namespace testing_rasters;

std::string WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}

std::string Collection(const std::vector<std::string>& features, const std::string& crs = {}) {
  std::string text = "{\"type\":\"FeatureCollection\",";
  if (!crs.empty()) text += "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"" + crs + "\"}},";
  text += "\"features\":[";
  for (size_t i = 0; i < features.size(); ++i) text += (i == 0 ? "" : ",") + features[i];
  return text + "]}";
}
std::string Json(const std::string& geometry, const std::string& properties) {
  return "{\"type\":\"Feature\",\"properties\":{" + properties + "},\"geometry\":" + geometry + "}";
}

SourceSpec SpecOf(const std::string& path, FeatureClass of) {
  GDALAllRegister();
  SourceSpec spec;
  spec.path = spec.written_path = path;
  spec.features = FeatureSelection{};
  spec.features->of = of;
  return spec;
}

// Of a file of these features; nothing where it cannot be read.
std::optional<FeatureSource> ReadFeatures(const std::string& name, const std::vector<std::string>& features,
                                          FeatureClass of) {
  const std::string path = WriteText(FreshFolder(name) + "/some.geojson", Collection(features));
  auto source = FeatureSource::Read(SpecOf(path, of));
  EXPECT_TRUE(source.ok()) << source.message();
  return source.ok() ? std::optional(std::move(*source)) : std::nullopt;
}

std::string ReasonOf(const SourceSpec& spec) {
  const auto source = FeatureSource::Read(spec);
  return source.ok() ? "it was read" : source.message();
}

// "none" where there is none.
std::string TextOf(const Feature& feature, const std::string& key) {
  for (const auto& [name, value] : feature.attributes) {
    if (name != key) continue;
    if (const auto* number = std::get_if<int64_t>(&value)) return fmt::format("whole {}", *number);
    if (const auto* real = std::get_if<double>(&value)) return fmt::format("real {}", *real);
    return std::get<std::string>(value);
  }
  return "none";
}

TEST(FeatureSource, ReadsEveryShapeAndTypeOfAttribute) {
  const std::string folder = FreshFolder("features_shapes");
  const std::string path = WriteText(
      folder + "/some.geojson",
      Collection(
          {Json("{\"type\":\"Point\",\"coordinates\":[8.5,47.25]}", "\"NAME\":\"Town\",\"people\":12000,\"share\":0.5"),
           Json("{\"type\":\"LineString\",\"coordinates\":[[8,47],[8.1,47.1],[8.1,47.1]]}", "\"NAME\":\"Way\""),
           Json("{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[4,0],[4,4],[0,4],[0,0]],[[1,1],[2,1],[2,2],[1,1]]]}",
                ""),
           Json("{\"type\":\"MultiPoint\",\"coordinates\":[[1,2],[3,4]]}", "")}));
  const auto source = FeatureSource::Read(SpecOf(path, FeatureClass::kOther));
  ASSERT_TRUE(source.ok()) << source.message();
  const auto& features = source->features();
  ASSERT_EQ(features.size(), 4u);
  EXPECT_EQ(features[0].shape, FeatureShape::kPoints);
  EXPECT_NEAR(features[0].parts[0][0].longitude_deg(), 8.5, 1e-7);
  EXPECT_NEAR(features[0].parts[0][0].latitude_deg(), 47.25, 1e-7);
  EXPECT_EQ(TextOf(features[0], "name"), "Town");
  EXPECT_EQ(TextOf(features[0], "people"), "whole 12000");
  EXPECT_EQ(TextOf(features[0], "share"), "real 0.5");
  EXPECT_EQ(features[1].shape, FeatureShape::kLines);
  EXPECT_EQ(features[1].parts[0].size(), 2u) << "a point that is said twice is one";
  EXPECT_EQ(features[2].shape, FeatureShape::kPolygons);
  ASSERT_EQ(features[2].parts.size(), 2u);
  EXPECT_EQ(features[2].parts[0].size(), 4u) << "rings are open";
  EXPECT_EQ(features[3].parts[0].size(), 2u);
  const SourceRecord record = source->Record();
  EXPECT_EQ(record.crs, "EPSG:4326");
  EXPECT_NEAR(record.extent.north_deg, 47.25, 1e-6);
  EXPECT_NE(record.state, "");
  EXPECT_TRUE(source->remarks().empty());
}

TEST(FeatureSource, BringsOtherSystemsToTheEarth) {
  const std::string folder = FreshFolder("features_crs");
  // Bern, in the Swiss grid: 46.951083 N, 7.438637 E (swisstopo's formulas).
  const std::string place = Json("{\"type\":\"Point\",\"coordinates\":[2600000,1200000]}", "");
  const std::string declared =
      WriteText(folder + "/declared.geojson", Collection({place}, "urn:ogc:def:crs:EPSG::2056"));
  SourceSpec given =
      SpecOf(WriteText(folder + "/given.csv", "easting,northing,name\n2600000,1200000,Bern\n"), FeatureClass::kPlace);
  given.crs = "EPSG:2056";
  for (const SourceSpec& spec : {SpecOf(declared, FeatureClass::kPlace), given}) {
    const auto source = FeatureSource::Read(spec);
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_NEAR(source->features()[0].parts[0][0].latitude_deg(), 46.951083, 1e-4);
    EXPECT_NEAR(source->features()[0].parts[0][0].longitude_deg(), 7.438637, 1e-4);
    EXPECT_EQ(source->Record().crs, "EPSG:2056");
  }
  given.crs = "EPSG:nothing";
  EXPECT_NE(ReasonOf(given).find("its crs \"EPSG:nothing\" is not known"), std::string::npos);
}

TEST(FeatureSource, ALineOver180GoesTheShortWay) {
  const auto source =
      ReadFeatures("features_180", {Json("{\"type\":\"LineString\",\"coordinates\":[[179.5,1],[-179.5,2]]}", "")},
                   FeatureClass::kRoad);
  ASSERT_TRUE(source);
  EXPECT_NEAR(source->features()[0].parts[0][1].longitude_deg(), 180.5, 1e-6);
}

TEST(FeatureSource, BordersAreOutlines) {
  const auto source =
      ReadFeatures("features_border", {Json("{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[4,0],[4,4],[0,0]]]}", "")},
                   FeatureClass::kBorder);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->features()[0].shape, FeatureShape::kLines);
  EXPECT_EQ(source->features()[0].parts[0].size(), 4u);
}

TEST(FeatureSource, WhatHasNoPlaceIsLeftOutAndSaid) {
  const std::string folder = FreshFolder("features_nowhere");
  const std::string good = Json("{\"type\":\"Point\",\"coordinates\":[1,2]}", "");
  const std::string far = Json("{\"type\":\"Point\",\"coordinates\":[1,200]}", "");
  const auto source = FeatureSource::Read(
      SpecOf(WriteText(folder + "/some.geojson", Collection({good, Json("null", ""), far})), FeatureClass::kPlace));
  ASSERT_TRUE(source.ok());
  EXPECT_EQ(source->features().size(), 1u);
  EXPECT_EQ(source->remarks(), std::vector<std::string>{"2 features have no place on the Earth and are left out"});
  EXPECT_EQ(ReasonOf(SpecOf(WriteText(folder + "/none.geojson", Collection({far})), FeatureClass::kPlace)),
            "it has no such feature with a place; of 1 it is missing or not on the Earth");
}

TEST(FeatureSource, TakesWhatItIsAskedFor) {
  const std::string folder = FreshFolder("features_where");
  std::string table = "lon,lat,label,rank,extra\n";
  for (int i = 0; i < 10; ++i) table += fmt::format("{},{},place {},{},x\n", i, i, i, 10 - i);
  SourceSpec spec = SpecOf(WriteText(folder + "/places.csv", table), FeatureClass::kPlace);
  spec.features->where = "rank > 4";
  spec.features->importance = "rank";
  spec.features->fields = {{"name", "label"}};
  const auto source = FeatureSource::Read(spec);
  ASSERT_TRUE(source.ok()) << source.message();
  ASSERT_EQ(source->features().size(), 6u);
  const Feature& second = source->features()[1];
  EXPECT_EQ(second.importance, 9);
  EXPECT_EQ(TextOf(second, "name"), "place 1");
  EXPECT_EQ(TextOf(second, "extra"), "none");
  EXPECT_EQ(TextOf(second, "label"), "none");
}

TEST(FeatureSource, SaysWhatIsWrong) {
  const std::string folder = FreshFolder("features_wrong");
  EXPECT_NE(ReasonOf(SpecOf(folder + "/missing.shp", FeatureClass::kRoad)).find("missing.shp"), std::string::npos);
  SourceSpec spec = SpecOf(WriteText(folder + "/a.csv", "lon,lat,size\n1,2,3\n"), FeatureClass::kRoad);
  spec.features->table = "b";
  EXPECT_EQ(ReasonOf(spec), "it has no table b; there are a");
  spec.features->table = "";
  spec.features->importance = "height";
  EXPECT_EQ(ReasonOf(spec), "its table a has no field \"height\"; there are lon, lat, size");
  spec.features->importance = "";
  spec.features->where = "size >";
  EXPECT_NE(ReasonOf(spec).find("its table a cannot be asked for \"size >\""), std::string::npos);
  spec.features->where = "size > 5";
  EXPECT_EQ(ReasonOf(spec), "it has no such feature with a place");
}

// Tags of OpenStreetMap, from XML, the tables as GDAL's driver has them.
TEST(FeatureSource, KnowsTheTagsOfOpenStreetMap) {
  const std::string folder = FreshFolder("features_osm");
  std::string text = "<osm version=\"0.6\">";
  const std::array<std::pair<double, double>, 5> places = {
      {{47, 9}, {47, 9.01}, {47.01, 9.01}, {47.01, 9}, {47.02, 9.02}}};
  for (size_t i = 0; i < places.size(); ++i) {
    text += fmt::format(
        "<node id=\"{}\" version=\"1\" lat=\"{}\" lon=\"{}\">{}</node>", i + 1, places[i].first, places[i].second,
        i == 4 ? "<tag k=\"place\" v=\"town\"/><tag k=\"name\" v=\"Ort\"/><tag k=\"population\" v=\"450\"/>" : "");
  }
  const auto way = [](int id, const std::string& nodes, const std::string& tags) {
    std::string out = fmt::format("<way id=\"{}\" version=\"1\">", id);
    for (const char node : nodes) out += fmt::format("<nd ref=\"{}\"/>", node);
    return out + tags + "</way>";
  };
  text += way(10, "12", "<tag k=\"highway\" v=\"motorway\"/>") + way(11, "34", "<tag k=\"highway\" v=\"service\"/>");
  text += way(12, "12341",
              "<tag k=\"building\" v=\"yes\"/><tag k=\"height\" v=\"12 m\"/><tag k=\"roof:shape\" v=\"gabled\"/>");
  text += way(13, "23", "<tag k=\"waterway\" v=\"river\"/>");
  const std::string path = WriteText(folder + "/some.osm", text + "</osm>");
  const auto roads = FeatureSource::Read(SpecOf(path, FeatureClass::kRoad));
  ASSERT_TRUE(roads.ok()) << roads.message();
  ASSERT_EQ(roads->features().size(), 2u);
  EXPECT_GT(roads->features()[0].importance, roads->features()[1].importance) << "motorways come first";
  const auto houses = FeatureSource::Read(SpecOf(path, FeatureClass::kBuilding));
  ASSERT_TRUE(houses.ok()) << houses.message();
  ASSERT_EQ(houses->features().size(), 1u);
  EXPECT_EQ(TextOf(houses->features()[0], "height"), "12 m");
  EXPECT_EQ(TextOf(houses->features()[0], "roof:shape"), "gabled");
  const auto towns = FeatureSource::Read(SpecOf(path, FeatureClass::kPlace));
  ASSERT_TRUE(towns.ok()) << towns.message();
  EXPECT_EQ(TextOf(towns->features()[0], "population"), "450");
  EXPECT_EQ(FeatureSource::Read(SpecOf(path, FeatureClass::kRiver))->features().size(), 1u);
  EXPECT_NE(ReasonOf(SpecOf(path, FeatureClass::kOther)).find("several tables"), std::string::npos);
}

TEST(FeatureSource, ParsesTags) {
  EXPECT_EQ(ParseTags(R"("a"=>"b","c d"=>"say \"x\"","e"=>"")"),
            (std::map<std::string, std::string>{{"a", "b"}, {"c d", "say \"x\""}, {"e", ""}}));
  EXPECT_EQ(ParseTags(R"("a"=>"b","c)"), (std::map<std::string, std::string>{{"a", "b"}}));
  EXPECT_TRUE(ParseTags("").empty());
  EXPECT_TRUE(ParseTags("nonsense").empty());
}

}  // namespace
}  // namespace belvedere

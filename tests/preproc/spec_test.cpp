#include "preproc/spec.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

std::string Message(const std::string& text) {
  const auto spec = ParseSpec(text, "dir/earth.toml");
  EXPECT_FALSE(spec.ok());
  return spec.message();
}
bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Spec, ReadsEveryKey) {
  const auto spec = ParseSpec(R"(
[[layer]]
name = "ground"
kind = "elevation"
  [[layer.source]]
  path = "a.tif"
  [[layer.source]]
  path = "/abs/b.tif"
  nodata = -32768
  crs = "EPSG:27700"
  georeference = [0, 1, 0, 0, 0, -1]
  unit = "us-ft"
  datum = 12.5
  feather_m = 300
[[layer]]
name = "colour"
kind = "imagery"
  [[layer.source]]
  path = "c.jpg"
  georeference = [-180, -90, 180, 90]
)",
                              "dir/earth.toml");
  ASSERT_TRUE(spec.ok()) << spec.message();
  ASSERT_EQ(spec->layers.size(), 2u);
  ASSERT_EQ(spec->layers[0].sources.size(), 2u);
  const SourceSpec& plain = spec->layers[0].sources[0];
  EXPECT_EQ(plain.path, "dir/a.tif");
  EXPECT_EQ(plain.written_path, "a.tif");
  EXPECT_EQ(plain.datum, VerticalDatum::kDeclared);
  EXPECT_FALSE(plain.nodata || plain.crs || plain.box || plain.geotransform || plain.metres_per_unit);
  const SourceSpec& full = spec->layers[0].sources[1];
  EXPECT_EQ(full.path, "/abs/b.tif");
  EXPECT_EQ(full.nodata, -32768.0);
  EXPECT_EQ(full.crs, "EPSG:27700");
  EXPECT_EQ(full.geotransform, (std::array<double, 6>{0, 1, 0, 0, 0, -1}));
  EXPECT_EQ(full.metres_per_unit, 1200.0 / 3937.0);
  EXPECT_EQ(full.datum, VerticalDatum::kOffset);
  EXPECT_EQ(full.datum_m, 12.5);
  EXPECT_EQ(full.feather_m, 300.0);
  ASSERT_TRUE(spec->layers[1].sources[0].box.has_value());
  EXPECT_EQ(spec->layers[1].sources[0].box->east_deg, 180.0);
}

TEST(Spec, PathsMayNameServersAndDrivers) {
  const auto path_of = [](const std::string& path, const std::string& more = "") {
    const auto spec = ParseSpec(
        "[[layer]]\nname = \"i\"\nkind = \"imagery\"\n[[layer.source]]\npath = '" + path + "'\n" + more + "\n",
        "dir/earth.toml");
    EXPECT_TRUE(spec.ok()) << spec.message();
    return spec.ok() ? spec->layers[0].sources[0].path : std::string();
  };
  EXPECT_EQ(path_of("https://a.org/b.tif?c=d"), "/vsicurl/https://a.org/b.tif?c=d");
  for (const char* as_it_is :
       {"WMS:https://a.org/wms", "/vsizip/a.zip/b.tif", "<GDAL_WMS></GDAL_WMS>", "GTIFF_DIR:2:a.tif"})
    EXPECT_EQ(path_of(as_it_is), as_it_is);
  EXPECT_EQ(path_of("c:d.tif"), "dir/c:d.tif") << "no driver has a small name";
  const std::string tiles = path_of("http://a.org/{z}/{x}/{y}.png?k=1&l=2", "zoom = 7");
  EXPECT_TRUE(Has(tiles, "http://a.org/${z}/${x}/${y}.png?k=1&amp;l=2")) << tiles;
  EXPECT_TRUE(Has(tiles, "<TileLevel>7</TileLevel>")) << tiles;
  EXPECT_TRUE(Has(tiles, "<YOrigin>top</YOrigin>")) << tiles;
  EXPECT_TRUE(Has(path_of("http://a.org/{z}/{x}/{-y}.png", "zoom = 0"), "<YOrigin>bottom</YOrigin>"));

  const std::string head = "[[layer]]\nname = \"i\"\nkind = \"imagery\"\n[[layer.source]]\npath = ";
  for (const char* wrong : {"\"http://a.org/{z}/{x}/{y}.png\"", "\"http://a.org/{z}/{x}/{y}.png\"\nzoom = 25",
                            "\"http://a.org/{z}/{x}/{y}.png\"\nzoom = \"7\"", "\"a.tif\"\nzoom = 7"}) {
    const std::string message = Message(head + wrong + "\n");
    EXPECT_TRUE(Has(message, "\"zoom\"") && Has(message, "dir/earth.toml:")) << wrong << ": " << message;
  }
}

TEST(Spec, TilesMayHaveAnExtent) {
  const std::string head = "[[layer]]\nname = \"i\"\nkind = \"imagery\"\n[[layer.source]]\nzoom = 3\npath = ";
  const std::string tiles = "\"http://a.org/{z}/{x}/{y}.png\"\nextent = ";
  const auto spec = ParseSpec(head + tiles + "[5, 40, 10, 50]\n", "dir/earth.toml");
  ASSERT_TRUE(spec.ok()) << spec.message();
  EXPECT_EQ(spec->layers[0].sources[0].extent->north_deg, 50);
  for (const char* wrong : {"[5, 40, 10]", "5", "[5, 40, 200, 50]", "[10, 40, 5, 50]", "[5, \"a\", 10, 50]"}) {
    const std::string message = Message(head + tiles + wrong + "\n");
    EXPECT_TRUE(Has(message, "\"extent\"") && Has(message, "dir/earth.toml:")) << wrong << ": " << message;
  }
  EXPECT_TRUE(Has(Message("[[layer]]\nname = \"i\"\nkind = \"imagery\"\n[[layer.source]]\npath = \"a.tif\"\n"
                          "extent = [5, 40, 10, 50]\n"),
                  "of tiles alone"));
}

TEST(Spec, AnUnknownKeyNamesFileLineKeyAndTheNearest) {
  const std::string message =
      Message("[[layer]]\nname = \"e\"\nkind = \"elevation\"\n[[layer.source]]\npath = \"a\"\nnodta = 3\n");
  for (const char* part : {"dir/earth.toml", ":6:", "\"nodta\"", "\"nodata\""})
    EXPECT_TRUE(Has(message, part)) << message;
  const std::string root = Message("layers = 3\n");
  for (const char* part : {":1:", "\"layers\"", "\"layer\""}) EXPECT_TRUE(Has(root, part)) << root;
  const std::string layer = Message("[[layer]]\nname = \"e\"\nkimd = \"elevation\"\n");
  for (const char* part : {":3:", "\"kimd\"", "\"kind\""}) EXPECT_TRUE(Has(layer, part)) << layer;
}

TEST(Spec, AWrongTypeNamesFileLineKeyAndWhatIsWanted) {
  const std::string head = "[[layer]]\nname = \"e\"\nkind = \"elevation\"\n[[layer.source]]\npath = \"a\"\n";
  const struct {
    const char *line, *key, *wanted;
  } kWrong[] = {{"nodata = \"x\"", "nodata", "number"},
                {"crs = 4326", "crs", "string"},
                {"feather_m = true", "feather_m", "number"},
                {"feather_m = -1", "feather_m", "negative"},
                {"unit = \"yard\"", "unit", "us-ft"},
                {"datum = \"egm84\"", "datum", "ellipsoid"},
                {"datum = true", "datum", "EPSG:3855"},
                {"georeference = [1, 2]", "georeference", "geotransform"},
                {"georeference = [10, 0, -10, 5]", "georeference", "west < east"},
                {"georeference = [1, 2, 3, \"4\"]", "georeference", "number"}};
  for (const auto& wrong : kWrong) {
    const std::string message = Message(head + wrong.line + "\n");
    for (const char* part : {"dir/earth.toml:6:", wrong.key, wrong.wanted}) EXPECT_TRUE(Has(message, part)) << message;
  }
  EXPECT_TRUE(Has(Message("[[layer]]\nname = 3\nkind = \"elevation\"\n"), ":2:"));
  EXPECT_TRUE(Has(Message("[[layer]]\nname = \"e\"\nkind = \"sound\"\n"), "sound"));
}

TEST(Spec, WhatIsMissingOrTwiceIsSaid) {
  EXPECT_TRUE(Has(Message(""), "no layer"));
  EXPECT_TRUE(Has(Message("[[layer]]\nkind = \"imagery\"\n"), "\"name\" is missing"));
  EXPECT_TRUE(Has(Message("[[layer]]\nname = \"i\"\nkind = \"imagery\"\n"), "no source"));
  const std::string layer = "[[layer]]\nname = \"i\"\nkind = \"imagery\"\n[[layer.source]]\npath = \"a\"\n";
  EXPECT_TRUE(Has(Message(layer + layer), "two layers"));
  EXPECT_TRUE(Has(Message(layer + "unit = \"m\"\n"), "imagery"));
  EXPECT_TRUE(Has(Message("[[layer]\n"), "dir/earth.toml:1:"));
  EXPECT_TRUE(Has(LoadSpec("/nonexistent/x.toml").message(), "/nonexistent/x.toml"));
}

TEST(Spec, SourcesWithTimesMakeALayerOfSteps) {
  const auto spec = ParseSpec(R"(
[[layer]]
name = "seasons"
kind = "imagery"
repeats = "year"
  [[layer.source]]
  path = "july.tif"
  time = "2004-07-01"
  [[layer.source]]
  path = "under.tif"
  [[layer.source]]
  path = "january.tif"
  time = "2004-01-01T01:00:00+01:00"
  [[layer.source]]
  path = "july_better.tif"
  time = "2004-07-01T00:00:00Z"
[[layer]]
name = "plain"
kind = "imagery"
  [[layer.source]]
  path = "a.tif"
)",
                              "earth.toml");
  ASSERT_TRUE(spec.ok()) << spec.message();
  ASSERT_EQ(spec->layers.size(), 3u);
  const auto paths = [](const LayerSpec& layer) {
    std::string text;
    for (const SourceSpec& source : layer.sources) text += source.written_path + " ";
    return text;
  };
  EXPECT_EQ(spec->layers[0].name, "seasons@2004-01-01T00:00:00Z");
  EXPECT_EQ(paths(spec->layers[0]), "under.tif january.tif ");
  EXPECT_EQ(spec->layers[1].name, "seasons@2004-07-01T00:00:00Z");
  EXPECT_EQ(paths(spec->layers[1]), "under.tif july.tif july_better.tif ") << "at one time the best is last";
  ASSERT_TRUE(spec->layers[1].step);
  EXPECT_EQ(spec->layers[1].step->layer, "seasons");
  EXPECT_EQ(spec->layers[1].step->repeats, Repeats::kEveryYear);
  EXPECT_FALSE(spec->layers[2].step);
  EXPECT_EQ(spec->layers[2].name, "plain");
}

TEST(Spec, WrongTimesAreSaid) {
  const auto layer = [](const std::string& kind, const std::string& repeats, const std::vector<std::string>& times) {
    std::string text = "[[layer]]\nname = \"i\"\nkind = \"" + kind + "\"\n" + repeats + "\n";
    for (const std::string& time : times) text += "[[layer.source]]\npath = \"a\"\n" + time + "\n";
    return text;
  };
  const std::string january = "time = \"2004-01-01\"", next = "time = \"2005-02-01\"";
  const std::string yearly = "repeats = \"year\"";
  const struct {
    std::string text;
    std::vector<const char*> parts;
  } kWrong[] = {{layer("imagery", "", {"time = \"winter\""}),
                 {"dir/earth.toml:7:", "\"time\"", "2004-01-01T00:00:00Z", "winter"}},
                {layer("imagery", "", {"time = \"2004-02-30\""}), {":7:", "2004-02-30"}},
                {layer("imagery", "", {"time = 2004-01-01"}), {":7:", "must be a string"}},
                {layer("elevation", "", {january}), {":7:", "\"time\" means nothing for elevation"}},
                {layer("imagery", "repeats = \"day\"", {january}), {":4:", "\"year\"", "\"day\""}},
                {layer("imagery", yearly, {""}), {":4:", "\"repeats\" needs sources with a \"time\""}},
                {layer("imagery", yearly, {january, next}), {":4:", "2004-01-01T00:00:00Z", "2005-02-01T00:00:00Z"}},
                {layer("imagery", "", {january}) + layer("imagery", "", {""}), {"two layers are named \"i\""}},
                {layer("imagery", "repeat = 1", {january}), {"\"repeat\"", "\"repeats\""}}};
  for (const auto& wrong : kWrong) {
    const std::string message = Message(wrong.text);
    for (const char* part : wrong.parts) EXPECT_TRUE(Has(message, part)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(Spec, PriorityIsByOrderUnlessResolutionIsAskedFor) {
  const auto text = [](const std::string& key, const std::string& more = "") {
    return "[[layer]]\nname = \"i\"\nkind = \"imagery\"\n" + key + "\n[[layer.source]]\npath = \"a\"\n" + more;
  };
  const auto priority = [&](const std::string& key, const std::string& more = "") {
    const auto spec = ParseSpec(text(key, more), "dir/earth.toml");
    EXPECT_TRUE(spec.ok()) << spec.message();
    return spec.ok() ? spec->layers.back().priority : Priority::kOrder;
  };
  EXPECT_EQ(priority(""), Priority::kOrder);
  EXPECT_EQ(priority("priority = \"order\""), Priority::kOrder);
  EXPECT_EQ(priority("priority = \"resolution\""), Priority::kResolution);
  EXPECT_EQ(priority("priority = \"resolution\"", "time = \"2004-01-01\"\n"), Priority::kResolution) << "of every step";
  const std::string message = Message(text("priority = \"age\""));
  for (const char* part : {"dir/earth.toml:4:", "\"priority\"", "\"resolution\"", "\"age\""})
    EXPECT_TRUE(Has(message, part)) << message;
  EXPECT_TRUE(Has(Message(text("priority = 1")), "must be a string"));
  EXPECT_TRUE(Has(Message(text("priorty = \"order\"")), "\"priority\""));
}

TEST(Spec, ColoursAreMatchedWhereThatIsAskedFor) {
  const auto text = [](const std::string& kind, const std::string& key) {
    return "[[layer]]\nname = \"i\"\nkind = \"" + kind + "\"\n[[layer.source]]\npath = \"a\"\n" + key + "\n";
  };
  for (const auto& [key, wanted] :
       {std::pair{"", false}, {"match_colour = true", true}, {"match_colour = false", false}}) {
    const auto spec = ParseSpec(text("imagery", key), "dir/earth.toml");
    ASSERT_TRUE(spec.ok()) << spec.message();
    EXPECT_EQ(spec->layers[0].sources[0].match_colour, wanted) << key;
  }
  const std::string wrong_type = Message(text("imagery", "match_colour = \"yes\""));
  for (const char* part : {"dir/earth.toml:6:", "\"match_colour\"", "true or false", "a string"})
    EXPECT_TRUE(Has(wrong_type, part)) << wrong_type;
  EXPECT_TRUE(
      Has(Message(text("elevation", "match_colour = true")), ":6: \"match_colour\" means nothing for elevation"));
  EXPECT_TRUE(Has(Message(text("imagery", "match_color = true")), "\"match_colour\""));
}

TEST(Spec, EachTimeCountsAsALayer) {
  std::string text = "[[layer]]\nname = \"i\"\nkind = \"imagery\"\n";
  for (int year = 1700; year <= 1700 + kMaxDatasetLayers; ++year) {
    text += "[[layer.source]]\npath = \"a\"\ntime = \"" + std::to_string(year) + "-01-01\"\n";
  }
  EXPECT_TRUE(Has(Message(text), "257 layers, each time of a layer counted, at most 256"));
}

}  // namespace
}  // namespace belvedere

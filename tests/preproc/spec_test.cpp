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
  EXPECT_EQ(plain.datum, VerticalDatum::kEgm96);
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

}  // namespace
}  // namespace belvedere

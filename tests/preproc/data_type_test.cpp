#include "preproc/types/data_type.h"

#include "preproc/spec.h"
#include "preproc/types/process_modules.h"
#include "tests/preproc/declared_types.h"

#include <gtest/gtest.h>

#include <string>

namespace belvedere {
namespace {

constexpr const char* kSlopeClasses = R"([[type]]
name = "slope classes"
parent = "elevation"
meta = "surface property"
read = "height pages"
process = ["slope", { module = "classes", limits = [5, 15.5], run = "series" }]
write = "property pages"
classes = [{ name = "flat", colour = "#8fbf6f" }, { name = "gentle", colour = "#e0d06080" }, { name = "steep", colour = "#000000" }]
)";
constexpr const char* kElevation = R"([[layer]]
name = "heights"
kind = "elevation"
[[layer.source]]
path = "a.tif"
)";

std::string Derived(const std::string& kind, const std::string& more = "") {
  return "[[layer]]\nname = \"made\"\nkind = \"" + kind + "\"\n" + more + "\n";
}
std::string Message(const std::string& text) {
  const auto spec = ParseSpec(text, "dir/earth.toml");
  return spec.ok() ? "" : spec.message();
}
std::string Without(std::string text, const std::string& part, const std::string& other = "") {
  const size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), other);
}

TEST(DataType, ASpecAddsOneAndALayerIsOfIt) {
  const auto spec = ParseSpec(std::string(kSlopeClasses) + kElevation + Derived("slope classes"), "dir/earth.toml");
  ASSERT_TRUE(spec.ok()) << spec.message();
  ASSERT_EQ(spec->layers.size(), 2U);
  const LayerSpec& layer = spec->layers[1];
  EXPECT_EQ(layer.kind, LayerKind::kProperty);
  ASSERT_TRUE(layer.derived.has_value());
  EXPECT_EQ(layer.derived->of, "heights");
  const DeclaredType& type = layer.derived->type;
  ASSERT_EQ(type.process.size(), 2U);
  EXPECT_EQ(type.process[0].module, "slope");
  EXPECT_FALSE(type.process[0].in_series);
  EXPECT_TRUE(type.process[1].in_series);
  EXPECT_EQ(type.process[1].settings.at("limits"), (std::vector<double>{5, 15.5}));
  EXPECT_EQ(type.property.classes[1].colour, (std::array<uint8_t, 4>{0xe0, 0xd0, 0x60, 0x80}));
  EXPECT_EQ(type.property.classes[0].colour[3], 255);
}

TEST(DataType, StockTypesAreInTheSameLanguage) {
  for (const char* name : {"elevation", "imagery", "slope angle", "normal map", "roughness", "water mask"})
    EXPECT_NE(DeclaredTypes::Stock().Find(name), nullptr) << name;
  EXPECT_TRUE(DeclaredTypes::Stock().Find("elevation")->parent.empty());
  EXPECT_EQ(KindOf(DeclaredTypes::Stock().Find("imagery")->meta), LayerKind::kImagery);
}

TEST(DataType, ATypeMayBeTheParentOfAnother) {
  const auto spec =
      ParseSpec(std::string(testing_types::kSteepType) + kElevation +
                    "[[layer]]\nname = \"angles\"\nkind = \"slope angle\"\n" + Derived("steep", "of = \"angles\""),
                "dir/earth.toml");
  ASSERT_TRUE(spec.ok()) << spec.message();
  EXPECT_EQ(spec->layers[2].derived->of, "angles");
}

TEST(DataType, WhatIsWrongIsNamedWithItsLine) {
  const std::string type = kSlopeClasses;
  const struct {
    std::string text;
    const char* part;
  } kWrong[] = {
      {Without(type, "\"elevation\"", "\"elevatoin\""), "to be its parent"},
      {Without(type, "\"slope\"", "\"slop\""), "no module \"slop\"; there are \"slope\""},
      {Without(type, "limits = [5, 15.5], "), "needs \"limits\""},
      {Without(type, "[5, 15.5]", "[5, \"x\"]"), "must be a number, here it is a string"},
      {Without(type, "run = \"series\"", "run = \"serial\""), "\"parallel\" or \"series\""},
      {Without(type, "\"slope\", "), "takes surface property, and gets height field"},
      {Without(Without(type, "\"height pages\"", "\"property pages\""), "\"slope\", "), "does not read its parent"},
      {Without(type, "\"property pages\"", "\"image pages\""), "are not of meta-type surface property"},
      {Without(type, "\"surface property\"", "\"surface\""), "\"meta\" must be"},
      {Without(type, "#8fbf6f", "#8fbf6"), "a class has"},
      {Without(type, "name = \"slope classes\"", "name = \"elevation\""), "there already"},
      {Without(type, "write =", "writes ="), "unknown key \"writes\"; the nearest known one is \"write\""},
      {Without(type, "parent =", "channels = 2\nparent ="), "2 channels, and its modules give 1"},
      {Without(type, "parent =", "channels = 1.5\nparent ="), "must be 1 to 4"},
      {Without(type, "parent =", "gain = \"x\"\nparent ="), "\"gain\" must be a number, here it is a string"},
      {Without(type, "parent =", "unit = 3\nparent ="), "\"unit\" must be a string, here it is a number"},
      {Without(type, "limits = [5, 15.5]", "limits = 5, limit = 3"), "no setting \"limit\""},
      {Without(type.substr(0, type.find("classes =")), "process", "gain = 0.5\nprocess"),
       "0 + 0.5 * byte, and its modules give 0 + 1 * byte"},
      {"type = 3\n", "[[type]]"},
      {type + kElevation + Derived("slope clases"), "there is no \"slope clases\""},
      {type + Derived("slope classes"), "none stands before it"},
      {type + kElevation + Derived("slope classes", "of = \"heights\"\n[[layer.source]]\npath = \"a\""), "\"source\""},
      {std::string(kElevation) + "of = \"x\"\n", "unknown key"},
  };
  for (const auto& [text, part] : kWrong) {
    const std::string message = Message(text);
    EXPECT_NE(message.find(part), std::string::npos) << part << ": " << message;
    EXPECT_EQ(message.find("dir/earth.toml:"), 0U) << message;
  }
}

TEST(DataType, ADatasetKeepsAllOfIt) {
  const auto spec = ParseSpec(std::string(kSlopeClasses) + kElevation + Derived("slope classes"), "dir/earth.toml");
  ASSERT_TRUE(spec.ok());
  const DeclaredType& type = spec->layers[1].derived->type;
  const auto read = TypeFromJson(TypeToJson(type));
  ASSERT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(TypeToJson(*read), TypeToJson(type));
  EXPECT_EQ(read->process[1].settings.at("limits"), (std::vector<double>{5, 15.5}));
  EXPECT_FALSE(TypeFromJson("{}").ok());
  EXPECT_NE(TypeFromJson(Without(TypeToJson(type), "\"slope\"", "\"other\"")).message().find("no module \"other\""),
            std::string::npos);
}

}  // namespace
}  // namespace belvedere

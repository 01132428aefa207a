#include "preproc/dataset_spec.h"

#include "preproc/open_layer.h"
#include "preproc/source_settings.h"
#include "runtime/paging/dataset_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace belvedere {
namespace {

BuildSpec Parsed(const std::string& text) {
  auto spec = ParseSpec(text, "/nowhere/spec.toml");
  EXPECT_TRUE(spec.ok()) << spec.message();
  return std::move(*spec);
}

std::string Layer(const std::string& name, const std::string& kind, const std::vector<std::string>& sources) {
  std::string text = "[[layer]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\n";
  for (const std::string& source : sources) text += "[[layer.source]]\n" + source + "\n";
  return text;
}

std::vector<std::string> Paths(const LayerSpec& layer) {
  std::vector<std::string> paths;
  for (const SourceSpec& source : layer.sources) paths.push_back(source.written_path);
  return paths;
}

// A dataset with no page, of one layer of one source.
std::unique_ptr<Dataset> DatasetOf(const std::string& name, int rules, const std::string& settings) {
  const std::string path = testing::TempDir() + "/belvedere_dataset_spec_" + name;
  std::filesystem::remove_all(path);
  LayerRecord layer;
  layer.name = "elevation";
  layer.rules = rules;
  layer.sources.push_back({"a.tif", "EPSG:4326", {0, 0, 1, 1}, {}, "egm96", 1, {}, {}, settings, "state"});
  auto writer = DatasetWriter::Create(path);
  EXPECT_TRUE(writer.ok() && (*writer)->Finish({layer}, "now").ok());
  auto dataset = Dataset::Open(path);
  EXPECT_TRUE(dataset.ok()) << dataset.message();
  return std::move(*dataset);
}

TEST(DatasetSpec, IsWhatTheDatasetWasBuiltOf) {
  const BuildSpec spec = Parsed(Layer("elevation", "elevation", {"path = \"a.tif\"\nunit = \"ft\"\nfeather_m = 7"}));
  const auto dataset = DatasetOf("same", kBuilderRules, SettingsToJson(spec.layers[0].sources[0]));
  const auto read = SpecOf(*dataset);
  ASSERT_TRUE(read.ok()) << read.message();
  ASSERT_EQ(read->layers.size(), 1u);
  EXPECT_EQ(read->layers[0].name, "elevation");
  EXPECT_EQ(SettingsToJson(read->layers[0].sources.at(0)), SettingsToJson(spec.layers[0].sources[0]));
  EXPECT_EQ(dataset->layers()[0].sources[0].state, "state");
}

TEST(DatasetSpec, ADatasetOfAnotherBuilderOrThatDoesNotKnowItIsRefused) {
  const std::string settings = SettingsToJson(Parsed(Layer("e", "elevation", {"path = \"a\""})).layers[0].sources[0]);
  for (const auto& dataset : {DatasetOf("rules", kBuilderRules + 1, settings), DatasetOf("older", 0, ""),
                              DatasetOf("settings", kBuilderRules, "")}) {
    EXPECT_FALSE(SpecOf(*dataset).ok());
  }
}

TEST(DatasetSpec, AddedSourcesLieOverThoseOfTheirLayer) {
  const BuildSpec spec = Parsed(Layer("e", "elevation", {"path = \"a\""}) + Layer("i", "imagery", {"path = \"b\""}));
  const auto more = WithAdded(spec, Parsed(Layer("i", "imagery", {"path = \"c\"", "path = \"d\""}) +
                                           Layer("new", "imagery", {"path = \"b\""})));
  ASSERT_TRUE(more.ok()) << more.message();
  ASSERT_EQ(more->layers.size(), 3u);
  EXPECT_EQ(Paths(more->layers[0]), std::vector<std::string>{"a"});
  EXPECT_EQ(Paths(more->layers[1]), (std::vector<std::string>{"b", "c", "d"}));
  EXPECT_EQ(more->layers[2].name, "new");
  EXPECT_FALSE(WithAdded(spec, Parsed(Layer("e", "imagery", {"path = \"c\""}))).ok()) << "of another kind";
  EXPECT_FALSE(WithAdded(spec, Parsed(Layer("i", "imagery", {"path = \"b\""}))).ok()) << "there already";
  EXPECT_TRUE(WithAdded(spec, Parsed(Layer("i", "imagery", {"path = \"b\"\nfeather_m = 5"}))).ok());
}

TEST(DatasetSpec, SourcesWithoutATimeLieUnderThoseWithOne) {
  const std::string winter = "path = \"w\"\ntime = \"2004-01-01\"", summer = "path = \"s\"\ntime = \"2004-07-01\"";
  const BuildSpec spec = Parsed(Layer("i", "imagery", {"path = \"a\"", winter, summer}));
  const auto more = WithAdded(spec, Parsed(Layer("i", "imagery", {"path = \"b\""})));
  ASSERT_TRUE(more.ok()) << more.message();
  EXPECT_EQ(Paths(more->layers.at(0)), (std::vector<std::string>{"a", "b", "w"}));
  EXPECT_EQ(Paths(more->layers.at(1)), (std::vector<std::string>{"a", "b", "s"}));
  const auto less = WithRemoved(*more, "a", "i");
  ASSERT_TRUE(less.ok()) << less.message();
  EXPECT_EQ(Paths(less->layers.at(0)), (std::vector<std::string>{"b", "w"}));
  EXPECT_EQ(Paths(less->layers.at(1)), (std::vector<std::string>{"b", "s"}));
  EXPECT_FALSE(WithRemoved(*more, "w", "").ok()) << "its step would have none of its own";
}

}  // namespace
}  // namespace belvedere

#include "runtime/paging/layer_table.h"

#include "runtime/base/iso_time.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

Layer MakeLayer(const std::string& name, PageKind kind, int max_level, std::function<bool(Quadcode)> exists) {
  Layer layer;
  layer.name = name;
  layer.kind = kind;
  layer.max_level = max_level;
  layer.exists = std::move(exists);
  return layer;
}

LayerTable SomeLayers() {
  const Quadcode deep = Quadcode::Containing(37, -118, 4);
  LayerTable table;
  table.Add(MakeLayer("elevation", PageKind::kElevation, 5, [deep](Quadcode q) {
    return q.is_root() || (q.level() <= 5 && q.Parent().Contains(deep)) || (q.level() == 5 && deep.Contains(q));
  }));
  table.Add(MakeLayer("imagery", PageKind::kColour, 2, [](Quadcode q) { return q.level() <= 2; }));
  table.Add(MakeLayer("more imagery", PageKind::kColour, 3, [](Quadcode) { return false; }));
  return table;
}

TEST(LayerTable, GivesOutDataTypesInOrder) {
  const LayerTable table = SomeLayers();
  EXPECT_EQ(table.size(), 3);
  for (int type = 0; type < table.size(); ++type) EXPECT_EQ(table.at(static_cast<DataType>(type)).type, type);
  EXPECT_EQ(table.Find("imagery")->type, 1);
  EXPECT_EQ(table.Find("nowhere"), nullptr);
  EXPECT_EQ(table.FirstOf(PageKind::kColour)->name, "imagery");
  EXPECT_EQ(table.FirstOf(PageKind::kModel), nullptr);
}

TEST(LayerTable, FindsTheDeepestPageThatExists) {
  const LayerTable table = SomeLayers();
  const Quadcode inside = Quadcode::Containing(37, -118, 12);
  EXPECT_EQ(table.DeepestExisting(0, inside), inside.Ancestor(5));
  EXPECT_EQ(table.DeepestExisting(0, inside.Ancestor(3)), inside.Ancestor(3));
  EXPECT_EQ(table.DeepestExisting(1, inside), inside.Ancestor(2));
  EXPECT_EQ(table.DeepestExisting(2, inside), std::nullopt);
  const Quadcode elsewhere = Quadcode::Containing(-20, 60, 9);
  EXPECT_EQ(table.DeepestExisting(0, elsewhere), elsewhere.Ancestor(0));
}

LayerTable WithSteps(Repeats repeats) {
  LayerTable table = SomeLayers();
  const auto step = [&](const char* name, const char* time) {
    Layer layer = MakeLayer(name, PageKind::kColour, 2, [](Quadcode) { return true; });
    layer.step = StepOf{"seasons", *ParseIsoTime(time), repeats};
    table.Add(std::move(layer));
  };
  step("seasons", "2004-07-01");  // whichever is added first stands for all
  step("seasons@2004-10-01T00:00:00Z", "2004-10-01");
  step("seasons@2004-01-01T00:00:00Z", "2004-01-01");
  return table;
}

TEST(LayerTable, OfALayersStepsThatOfTheTimeIsUsed) {
  const LayerTable table = WithSteps(Repeats::kNever);
  const DataType seasons = table.Find("seasons")->type;
  const auto name_at = [&](const char* time) { return table.at(table.TypeAt(seasons, *ParseIsoTime(time))).name; };
  EXPECT_EQ(name_at("1999-12-01"), "seasons@2004-01-01T00:00:00Z");
  EXPECT_EQ(name_at("2004-06-30"), "seasons@2004-01-01T00:00:00Z");
  EXPECT_EQ(name_at("2004-07-01"), "seasons");
  EXPECT_EQ(name_at("2026-07-01"), "seasons@2004-10-01T00:00:00Z");
  const LayerTable yearly = WithSteps(Repeats::kEveryYear);
  EXPECT_EQ(yearly.at(yearly.TypeAt(seasons, *ParseIsoTime("2026-07-01"))).name, "seasons");
  EXPECT_EQ(table.TypeAt(table.Find("imagery")->type, 0), table.Find("imagery")->type) << "it does not change";
}

TEST(LayerTable, OneOfTheStepsStandsForAll) {
  const LayerTable table = WithSteps(Repeats::kEveryYear);
  EXPECT_EQ(table.Find("seasons")->steps.size(), 3U);
  EXPECT_TRUE(table.Find("seasons")->is_whole());
  EXPECT_TRUE(table.Find("imagery")->is_whole());
  EXPECT_FALSE(table.Find("seasons@2004-01-01T00:00:00Z")->is_whole());
  EXPECT_TRUE(table.Find("seasons@2004-01-01T00:00:00Z")->steps.empty());
}

}  // namespace
}  // namespace belvedere

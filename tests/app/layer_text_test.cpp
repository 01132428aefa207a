#include "runtime/app/layer_text.h"

#include <gtest/gtest.h>

namespace belvedere {
namespace {

LayerTable Table() {
  LayerTable table;
  const auto all = [](Quadcode) { return true; };
  table.Add({"heights", PageKind::kElevation, 0, 5, all});
  table.Add({"imagery", PageKind::kColour, 0, 5, all});
  table.Add({"cities", PageKind::kColour, 0, 5, all});
  table.Add({"relief", PageKind::kOverlay, 0, 5, all, LayerRole::kMultiply});
  table.Add({"sea", PageKind::kOverlay, 0, 5, all, LayerRole::kWater});
  return table;
}

TEST(LayerText, WithoutNamesItIsTheFirstColourAndWhatMultipliesIt) {
  const auto layers = LayersOf({}, Table());
  ASSERT_TRUE(layers.ok());
  ASSERT_EQ(layers->size(), 2U);
  EXPECT_EQ((*layers)[0].name, "imagery");
  EXPECT_EQ((*layers)[1].name, "relief");
  EXPECT_EQ((*layers)[1].use.role, LayerRole::kMultiply);
}

TEST(LayerText, SettingsFollowTheName) {
  const auto layers = LayersOf({"imagery:opacity=0.5:gamma=1.5", "cities:role=night:multiplier=2:off", "sea"}, Table());
  ASSERT_TRUE(layers.ok()) << layers.message();
  const LayerUse& imagery = (*layers)[0].use;
  EXPECT_EQ(imagery.type, 1);
  EXPECT_FLOAT_EQ(imagery.opacity, 0.5F);
  EXPECT_FLOAT_EQ(imagery.gamma, 1.5F);
  EXPECT_TRUE(imagery.on);
  const LayerUse& cities = (*layers)[1].use;
  EXPECT_EQ(cities.role, LayerRole::kNight);
  EXPECT_FLOAT_EQ(cities.multiplier, 2.0F);
  EXPECT_FALSE(cities.on);
  EXPECT_FALSE(cities.shown());
  EXPECT_EQ((*layers)[2].use.role, LayerRole::kWater);
  EXPECT_EQ(UsesOf(*layers).size(), 3U);
}

TEST(LayerText, MistakesAreNamed) {
  const auto message = [](const std::vector<std::string>& texts) {
    const auto layers = LayersOf(texts, Table());
    return layers.ok() ? std::string() : std::string(layers.message());
  };
  EXPECT_NE(message({"imagry"}).find("did you mean imagery?"), std::string::npos);
  EXPECT_NE(message({"heights"}).find("no image layer"), std::string::npos);
  EXPECT_NE(message({"imagery:opacity=2"}).find("layer imagery: \"opacity=2\" is wrong"), std::string::npos);
  EXPECT_NE(message({"imagery:opacity=nan"}).find("wrong"), std::string::npos);
  EXPECT_NE(message({"imagery:role=sky"}).find("role=sky"), std::string::npos);
  EXPECT_NE(message({"imagery:"}).find("wrong"), std::string::npos);
  EXPECT_NE(message({"imagery", "relief", "imagery"}).find("twice"), std::string::npos);
  EXPECT_NE(message({"a", "b", "c", "d", "e", "f", "g"}).find("at most 6"), std::string::npos);
}

TEST(LayerText, WithoutImageryOnlyTheReliefIsShown) {
  LayerTable table;
  const auto all = [](Quadcode) { return true; };
  Layer grid{"grid", PageKind::kColour, 0, 5, all};
  grid.is_made = true;
  table.Add(grid);
  table.Add({"relief", PageKind::kOverlay, 0, 5, all, LayerRole::kMultiply});
  const auto layers = LayersOf({}, table);
  ASSERT_EQ(layers->size(), 1U);
  EXPECT_EQ((*layers)[0].name, "relief");
  EXPECT_EQ(LayersOf({"grid"}, table)->size(), 1U) << "by its name it can be had";
}

TEST(LayerText, ALayerWithStepsIsOne) {
  LayerTable table;
  for (const char* name : {"seasons", "seasons@2004-07-01T00:00:00Z"}) {
    Layer layer{name, PageKind::kColour, 0, 5, [](Quadcode) { return true; }};
    layer.step = StepOf{"seasons", static_cast<double>(table.size()), Repeats::kNever};
    table.Add(std::move(layer));
  }
  const auto layers = LayersOf({"seasons:opacity=0.5"}, table);
  ASSERT_TRUE(layers.ok()) << layers.message();
  EXPECT_EQ((*layers)[0].use.type, 0);
  EXPECT_EQ(LayersOf({}, table)->size(), 1U);
  const auto unknown = LayersOf({"colour"}, table);
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.message().find("there are seasons"), std::string::npos) << unknown.message();
  EXPECT_EQ(unknown.message().find("seasons@"), std::string::npos) << unknown.message();
}

}  // namespace
}  // namespace belvedere

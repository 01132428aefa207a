#include "runtime/paging/layer_table.h"

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

}  // namespace
}  // namespace belvedere

#include "servers/stock_modules.h"

#include "runtime/earth/frame.h"
#include "servers/terrain_builder.h"
#include "tests/servers/small_dataset.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace belvedere {
namespace {

const Quadcode kFine = Quadcode::Root(20);
const Quadcode kOtherRoot = Quadcode::Root(21);

// The whole of what a run has between a dataset and its servers, without their threads.
class House {
 public:
  explicit House(const SmallDatasetOptions& options = {}, double exaggeration = 1) : small_(options) {
    StockOptions stock;
    stock.exaggeration = exaggeration;
    registered_ = RegisterStockModules(registry_, *small_, models_, stock);
    paging_ = std::make_unique<Paging>(MakeLayerTable(registry_), size_t{64} << 20, clock_);
  }
  const Status& registered() const { return registered_; }
  Paging& paging() { return *paging_; }
  const Layer& layer(const char* name) const { return *paging_->layers.Find(name); }
  Result<PagePin> Read(const char* name, Quadcode node) {
    return ReadIntoCache(*paging_, registry_, {layer(name).type, node});
  }

 private:
  SmallDataset small_;
  ModelCatalogue models_{std::string(BELVEDERE_SOURCE_DIR) + "/servers/models", {{"car", 4.5F}}};
  ManualClock clock_;
  ModuleRegistry registry_;
  Status registered_;
  std::unique_ptr<Paging> paging_;
};

TEST(StockModules, MakeALayerTable) {
  House house;
  ASSERT_TRUE(house.registered().ok()) << house.registered().message();
  EXPECT_EQ(house.layer("elevation").kind, PageKind::kElevation);
  EXPECT_EQ(house.layer("imagery").kind, PageKind::kColour);
  EXPECT_EQ(house.layer("terrain").kind, PageKind::kTerrain);
  EXPECT_EQ(house.layer("relief").kind, PageKind::kOverlay);
  EXPECT_EQ(house.layer("model").kind, PageKind::kModel);
  EXPECT_EQ(house.layer("slope").kind, PageKind::kColour);
  EXPECT_EQ(house.layer("contours").kind, PageKind::kColour);
  EXPECT_EQ(house.layer("grid").kind, PageKind::kColour);
  EXPECT_EQ(house.layer("quadcodes").kind, PageKind::kColour);
  EXPECT_EQ(house.layer("water").kind, PageKind::kOverlay);
  EXPECT_EQ(house.layer("relief").role, LayerRole::kMultiply);
  EXPECT_EQ(house.layer("water").role, LayerRole::kWater);
  EXPECT_EQ(house.paging().layers.size(), 10);
  for (int tree = 0; tree < kTrees; ++tree) EXPECT_TRUE(house.layer("terrain").exists(Quadcode::Root(tree)));
}

TEST(StockModules, TerrainLiesWhereverAnythingDoes) {
  House house;
  const Layer& terrain = house.layer("terrain");
  EXPECT_TRUE(terrain.exists(kFine.Child(3).Child(0)));
  EXPECT_FALSE(terrain.exists(kFine.Child(2).Child(0)));
  EXPECT_TRUE(terrain.exists(kOtherRoot.Child(1)));  // imagery alone
  EXPECT_FALSE(terrain.exists(kOtherRoot.Child(1).Child(1)));
  EXPECT_EQ(terrain.max_level, 2);
  EXPECT_FALSE(house.layer("relief").exists(kOtherRoot.Child(1)));
  EXPECT_TRUE(house.layer("relief").exists(kFine.Child(3).Child(0)));
}

TEST(StockModules, ReadEveryKindOfPage) {
  House house;
  const Result<PagePin> elevation = house.Read("elevation", kFine);
  ASSERT_TRUE(elevation.ok()) << elevation.message();
  EXPECT_EQ(elevation->as<ElevationPage>().at(17, 80), MakeElevation(kFine, WavyHeight)->at(17, 80));

  const Result<PagePin> imagery = house.Read("imagery", kFine);
  ASSERT_TRUE(imagery.ok()) << imagery.message();
  const auto& image = imagery->as<ImagePage>();
  EXPECT_EQ(image.texels[ImagePage::MipOffset(2, ImageFormat::kRGBA8) + 2], 80);  // the smallest level is filled

  const Result<PagePin> terrain = house.Read("terrain", kFine);
  ASSERT_TRUE(terrain.ok()) << terrain.message();
  EXPECT_EQ(terrain->as<TerrainPage>().node, kFine);
  EXPECT_GT(terrain->as<TerrainPage>().error_m, 50);  // finer heights exist

  const Result<PagePin> relief = house.Read("relief", kFine);
  ASSERT_TRUE(relief.ok()) << relief.message();
  EXPECT_EQ(relief->as<ImagePage>().format, ImageFormat::kR8);

  const Result<PagePin> model = house.Read("model", ModelCatalogue::ModelNode(0));
  ASSERT_TRUE(model.ok()) << model.message();
  EXPECT_FALSE(model->as<ModelPage>().details.empty());
  EXPECT_FALSE(house.layer("model").exists(ModelCatalogue::ModelNode(1)));
}

TEST(StockModules, MadeImagesHaveTheFormatOfTheirKindAndExistWithWhatTheyAreMadeOf) {
  House house;
  for (const char* name : {"slope", "contours", "water", "grid", "quadcodes"}) {
    const Layer& layer = house.layer(name);
    const Result<PagePin> page = house.Read(name, kFine.Child(3));
    ASSERT_TRUE(page.ok()) << name << ": " << page.message();
    const auto& image = page->as<ImagePage>();
    EXPECT_EQ(image.format, layer.kind == PageKind::kColour ? ImageFormat::kRGBA8 : ImageFormat::kR8) << name;
    EXPECT_EQ(image.texels.size(), ImagePage::MipOffset(kImageMipLevels, image.format)) << name;
    const bool of_quadnodes = name == std::string_view("grid") || name == std::string_view("quadcodes");
    EXPECT_EQ(layer.exists(kOtherRoot.Child(1)), of_quadnodes) << name;  // imagery alone
  }
}

TEST(StockModules, HeightsAreTakenFromTheCache) {
  House house;
  ASSERT_TRUE(house.Read("terrain", kFine).ok());
  EXPECT_TRUE(house.paging().cache.Contains({house.layer("elevation").type, kFine}));
  const uint64_t hits = house.paging().cache.Stats().hits;
  ASSERT_TRUE(house.Read("relief", kFine).ok());
  EXPECT_EQ(house.paging().cache.Stats().hits, hits + 1);
}

TEST(StockModules, ImageryFinerThanHeightsLiesOnInterpolatedOnes) {
  House house;
  const Quadcode node = kOtherRoot.Child(2);
  const Result<PagePin> terrain = house.Read("terrain", node);
  ASSERT_TRUE(terrain.ok()) << terrain.message();
  EXPECT_EQ(terrain->as<TerrainPage>().error_m, 0);
  const auto root = MakeElevation(kOtherRoot, WavyHeight);
  const auto expected = BuildTerrain({node, root.get(), kOtherRoot, false, 1});
  EXPECT_EQ(terrain->as<TerrainPage>().vertices[5000].z, expected->vertices[5000].z);
}

glm::dvec3 VertexEcef(const TerrainPage& page, int column, int row) {
  const TerrainVertex& v = page.vertices[static_cast<size_t>(row * kPosts + column)];
  return FrameOf(page.node).ToEcef({v.x, v.y, v.z});
}

// Where finer data end, the two surfaces are one along the line.
TEST(StockModules, ABorderBeyondWhichHeightsAreCoarserLiesOnTheCoarserEdge) {
  constexpr double kRounding_m = 1.0;  // of coarse quadnodes' vertices
  House house;
  const Quadcode fine = Quadcode::Root(20).Child(0);
  const Result<PagePin> finer = house.Read("terrain", fine);
  const Result<PagePin> coarser = house.Read("terrain", Quadcode::Root(19));
  ASSERT_TRUE(finer.ok() && coarser.ok());
  const auto& page = finer->as<TerrainPage>();
  const auto& edge = coarser->as<TerrainPage>();
  double most_moved_m = 0;
  const auto heights = MakeElevation(fine, WavyHeight);
  const auto alone = BuildTerrain({fine, heights.get(), fine, false, 1});
  for (int row = 0; row < kPosts; ++row) {
    const glm::dvec3 south = VertexEcef(edge, kCells, row / 2);
    const glm::dvec3 north = VertexEcef(edge, kCells, (row + 1) / 2);
    EXPECT_LT(glm::distance(VertexEcef(page, 0, row), 0.5 * (south + north)), kRounding_m) << row;
    most_moved_m = std::max(most_moved_m, glm::distance(VertexEcef(page, 0, row), VertexEcef(*alone, 0, row)));
    if (row == 0) continue;  // of the southern border, which is laid as well
    EXPECT_EQ(VertexEcef(page, 1, row), VertexEcef(*alone, 1, row)) << "no further than the border";
  }
  EXPECT_GT(most_moved_m, 10);
  EXPECT_LE(page.min_height_m, alone->min_height_m);
}

// Imagery that is finer than the heights has ground as fine beside it, made of coarser heights.
TEST(StockModules, ABorderBesideGroundAsFineOfCoarserHeightsLiesOnThat) {
  House house;
  const Result<PagePin> west = house.Read("terrain", Quadcode::Root(20).Child(1));
  const Result<PagePin> east = house.Read("terrain", Quadcode::Root(21).Child(0));
  ASSERT_TRUE(west.ok() && east.ok());
  for (int row = 1; row < kPosts; ++row) {
    EXPECT_LT(
        glm::distance(VertexEcef(west->as<TerrainPage>(), kCells, row), VertexEcef(east->as<TerrainPage>(), 0, row)),
        1.0);
  }
}

TEST(StockModules, ADamagedPageIsKnownAndItsGroundFallsBack) {
  SmallDatasetOptions options;
  options.damaged = kFine.Child(3);
  House house(options);
  const Result<PagePin> terrain = house.Read("terrain", kFine.Child(3));
  ASSERT_TRUE(terrain.ok()) << terrain.message();
  EXPECT_GT(terrain->as<TerrainPage>().error_m, 50);  // its own children are finer still
  const PageKey elevation{house.layer("elevation").type, kFine.Child(3)};
  EXPECT_NE(house.paging().cache.FailureOf(elevation).message().find(kFine.Child(3).ToString()), std::string::npos);
  EXPECT_EQ(house.paging().cache.Stats().failed_pages, 1u);
  EXPECT_FALSE(house.Read("relief", kFine.Child(3)).ok());
  EXPECT_EQ(house.paging().cache.Stats().failed_pages, 2u);
  EXPECT_TRUE(house.Read("terrain", kFine.Child(3).Child(0)).ok());
}

TEST(StockModules, ADamagedRootIsDrawnFlat) {
  SmallDatasetOptions options;
  options.damaged = Quadcode::Root(7);
  House house(options);
  const Result<PagePin> terrain = house.Read("terrain", Quadcode::Root(7));
  ASSERT_TRUE(terrain.ok()) << terrain.message();
  EXPECT_EQ(terrain->as<TerrainPage>().max_height_m, 0);
  EXPECT_EQ(house.paging().cache.Stats().failed_pages, 1u);
}

TEST(StockModules, WithNoHeightsAtAllThereIsStillAnEarth) {
  SmallDatasetOptions options;
  options.has_elevation = false;
  House house(options);
  ASSERT_TRUE(house.registered().ok()) << house.registered().message();
  EXPECT_EQ(house.paging().layers.Find("relief"), nullptr);
  const Result<PagePin> terrain = house.Read("terrain", kOtherRoot.Child(0));
  ASSERT_TRUE(terrain.ok()) << terrain.message();
  EXPECT_EQ(terrain->as<TerrainPage>().min_height_m, 0);
}

TEST(StockModules, ExaggerationReachesTheTerrain) {
  House plain;
  House tall({}, 2);
  const Result<PagePin> low = plain.Read("terrain", kFine);
  const Result<PagePin> high = tall.Read("terrain", kFine);
  ASSERT_TRUE(low.ok() && high.ok());
  EXPECT_FLOAT_EQ(high->as<TerrainPage>().max_height_m, 2 * low->as<TerrainPage>().max_height_m);
}

TEST(StockModules, ALayerMayNotTakeTheNameOfAnother) {
  SmallDatasetOptions options;
  options.elevation_name = "terrain";
  House house(options);
  EXPECT_NE(house.registered().message().find("terrain"), std::string::npos);
}

TEST(StockModules, StepsOfALayerAreReadEachAndNamedAsOne) {
  SmallDatasetOptions options;
  options.season_greys = {50, 200};
  House house(options);
  ASSERT_TRUE(house.registered().ok()) << house.registered().message();
  const Layer& seasons = house.layer("seasons");
  ASSERT_EQ(seasons.steps.size(), 2U);
  EXPECT_EQ(house.paging().layers.FirstOf(PageKind::kColour)->name, "imagery");
  for (const size_t step : {0U, 1U}) {
    const DataType type = house.paging().layers.TypeAt(seasons.type, SmallDataset::SeasonTime(step));
    const Layer& layer = house.paging().layers.at(type);
    EXPECT_EQ(layer.is_whole(), step == 0);
    const Result<PagePin> page = house.Read(layer.name.c_str(), kOtherRoot);
    ASSERT_TRUE(page.ok()) << page.message();
    EXPECT_EQ(page->as<ImagePage>().texels[4 * 1000], options.season_greys[step]);
  }
}

TEST(StockModules, ALayerWithStepsMayNotTakeTheNameOfAnother) {
  SmallDatasetOptions options;
  options.season_greys = {50, 200};
  options.seasons_name = "relief";
  EXPECT_NE(House(options).registered().message().find("relief"), std::string::npos);
}

}  // namespace
}  // namespace belvedere

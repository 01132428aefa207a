#include "servers/stock_modules.h"

#include "servers/terrain_builder.h"
#include "tests/servers/small_dataset.h"

#include <gtest/gtest.h>

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

// Where the data of a quadnode end and its neighbour's go on, what is finer there must not pull at large triangles.
TEST(StockModules, FinerPagesBesideAQuadnodeRaiseItsDeltaValuesAlongTheBorder) {
  House house;
  const Result<PagePin> beside = house.Read("terrain", Quadcode::Root(21));  // east of root 20, which goes on
  const Result<PagePin> away = house.Read("terrain", Quadcode::Root(23));
  ASSERT_TRUE(beside.ok() && away.ok());
  const auto& page = beside->as<TerrainPage>();
  EXPECT_EQ(page.error_m, 0);
  const auto delta_m = [&](int column, int row) { return page.deltas[static_cast<size_t>(row * kPosts + column)]; };
  const auto root = MakeElevation(Quadcode::Root(21), WavyHeight);
  const auto alone = BuildTerrain({Quadcode::Root(21), root.get(), Quadcode::Root(21), false, 1});
  for (const int row : {3, 60, 125}) {
    const auto inner = static_cast<size_t>(row * kPosts + 1);
    const auto far = static_cast<size_t>(row * kPosts + 101);
    EXPECT_GE(delta_m(1, row), 50 + 0.9F * alone->deltas[inner]);
    EXPECT_EQ(delta_m(101, row), alone->deltas[far]);
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

}  // namespace
}  // namespace belvedere

// What a report is drawn from: pictures of layers, maps of their levels, and how their heights are spread.
#include "preproc/preview.h"

#include "preproc/height_histogram.h"
#include "preproc/raster_reader.h"
#include "tests/preproc/made_raster.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace belvedere {
namespace {

using namespace testing_rasters;

const Geoid& Egm96() {
  static const auto geoid = Geoid::LoadEgm96();
  EXPECT_TRUE(geoid.ok()) << geoid.message();
  return **geoid;
}

// Red in the west, blue in the east, and nothing south of 45 S.
TEST(Preview, APictureOfImageryHasTheNorthOnTopAndTheWestLeft) {
  const std::string folder = FreshFolder("preview_colours");
  Write(folder + "/halves.tif",
        {.width = 720,
         .height = 270,
         .bands = 3,
         .type = GDT_Byte,
         .affine = Degrees(-180, 90, 0.5),
         .value = [](int band, int column, int) { return band == (column < 360 ? 1 : 3) ? 200.0 : 20.0; }});
  MustBuild(folder, Layer("imagery", {"path = \"halves.tif\""}));
  const auto dataset = MustOpen(folder);
  const auto preview = PreviewOf(*dataset, 0, {-180, -90, 180, 90}, 300, Egm96());
  ASSERT_TRUE(preview.ok()) << preview.message();
  const Picture& picture = preview->picture;
  EXPECT_LE(picture.width, 300);
  EXPECT_GE(picture.width, 150);
  EXPECT_NEAR(picture.height, picture.width / 2, 1);
  EXPECT_EQ(preview->level, 0) << "coarse pages are enough";
  EXPECT_EQ(picture.At(10, 10), (Rgb{200, 20, 20}));
  EXPECT_EQ(picture.At(picture.width - 10, 10), (Rgb{20, 20, 200}));
  EXPECT_EQ(picture.At(10, picture.height - 5), (Rgb{235, 235, 235})) << "transparent";
}

TEST(Preview, HeightsAreTintedAboveTheSeaAndShadedFromTheNorthWest) {
  const std::string folder = FreshFolder("preview_heights");
  // Sea at -4000 m, and in its middle a ridge from south to north.
  Write(folder + "/ridge.tif",
        {.width = 360, .height = 180, .affine = Degrees(-180, 90, 1), .value = [](int, int column, int) {
           const int from_middle = std::abs(column - 180);
           return from_middle < 40 ? 3000.0 - 50 * from_middle : -4000.0;
         }});
  MustBuild(folder, Layer("elevation", {"path = \"ridge.tif\""}));
  const auto dataset = MustOpen(folder);
  const auto preview = PreviewOf(*dataset, 0, {-180, -90, 180, 90}, 360, Egm96());
  ASSERT_TRUE(preview.ok()) << preview.message();
  const Picture& picture = preview->picture;
  const auto at = [&](double longitude) {
    return picture.At(static_cast<int>((longitude + 180) / 360 * picture.width), picture.height / 2);
  };
  const Rgb sea = at(-100), west = at(-20), east = at(20);
  EXPECT_GT(sea[2], sea[0] + 50) << "blue";
  EXPECT_GT(west[0], west[2]) << "land is not";
  EXPECT_GT(west[0], east[0] + 10) << "the west slope is in the light";
}

// South of India the geoid lies 100 m under the ellipsoid, and what is dry is still no sea.
TEST(Preview, LandIsWhatIsAboveTheSeaNotTheEllipsoid) {
  const std::string folder = FreshFolder("preview_sea");
  Write(folder + "/low.tif",
        {.width = 36, .height = 18, .affine = Degrees(-180, 90, 10), .value = [](int, int, int) { return 5.0; }});
  MustBuild(folder, Layer("elevation", {"path = \"low.tif\""}));
  const auto preview = PreviewOf(*MustOpen(folder), 0, {70, -5, 90, 15}, 100, Egm96());
  ASSERT_TRUE(preview.ok()) << preview.message();
  const Picture& picture = preview->picture;
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column)
      ASSERT_GT(picture.At(column, row)[0], picture.At(column, row)[2]) << column << " " << row;
  }
}

TEST(Preview, WhereItIsFinestIsShownFromPagesFineEnough) {
  const std::string folder = FreshFolder("preview_finest");
  Write(folder + "/small.tif",
        {.width = 400, .height = 400, .affine = Degrees(10, 47, 0.001), .value = [](int, int column, int) {
           return 10.0 * column;
         }});
  MustBuild(folder, Layer("elevation", {"path = \"small.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  const auto box = FinestBox(*dataset, 0);
  ASSERT_TRUE(box.ok());
  EXPECT_LE(box->west_deg, 10);
  EXPECT_GE(box->east_deg, 10.4);
  EXPECT_LT(box->east_deg - box->west_deg, 1);
  const auto preview = PreviewOf(*dataset, 0, *box, 200, Egm96());
  ASSERT_TRUE(preview.ok()) << preview.message();
  EXPECT_LT(preview->level, dataset->MaxLevel(0)) << "not from all of the finest pages";
  EXPECT_GE(std::max(preview->picture.width, preview->picture.height), 100);
}

TEST(Preview, TheMapShowsTheFinestLevelAtEachPlace) {
  const std::string folder = FreshFolder("preview_map");
  const auto seven = [](int, int, int) { return 7.0; };
  Write(folder + "/north.tif", {.width = 800, .height = 160, .affine = Degrees(-180, 90, 0.1), .value = seven});
  Write(folder + "/dot.tif", {.width = 4, .height = 4, .affine = Degrees(100, -30, 0.001), .value = seven});
  MustBuild(folder, Layer("elevation", {"path = \"north.tif\"", "path = \"dot.tif\""}));
  const auto dataset = MustOpen(folder);
  const int finest = dataset->MaxLevel(0);
  ASSERT_GT(finest, 6);
  const std::array<int, 1> layers{0};
  const Picture map = MapOfLevels(*dataset, layers, 720);
  ASSERT_EQ(map.height, 360);
  const auto at = [&](double latitude, double longitude) {
    return map.At(static_cast<int>((longitude + 180) * 2), static_cast<int>((90 - latitude) * 2));
  };
  EXPECT_EQ(at(80, -150), LevelColour(dataset->FinestContaining(0, 80, -150).level(), finest));
  EXPECT_EQ(at(-10, -10), LevelColour(0, finest));
  EXPECT_EQ(at(-30.1, 100.1), LevelColour(finest, finest)) << "what is under a pixel is seen";
  EXPECT_NE(LevelColour(0, finest), LevelColour(finest, finest));
}

TEST(Preview, AnUriHoldsThePicture) {
  GDALAllRegister();
  Picture picture(40, 20);
  for (int column = 0; column < 40; ++column) {
    for (int row = 0; row < 20; ++row)
      picture.Set(column, row, {static_cast<uint8_t>(5 * column), static_cast<uint8_t>(10 * row), 99});
  }
  for (const auto& [format, name, tolerance] :
       {std::tuple{PictureFormat::kPng, "png", 0}, std::tuple{PictureFormat::kJpeg, "jpeg", 12}}) {
    std::string uri = DataUri(picture, format);
    const std::string head = std::string("data:image/") + name + ";base64,";
    ASSERT_EQ(uri.rfind(head, 0), 0u) << uri.substr(0, 40);
    std::string bytes = uri.substr(head.size());
    const int count = CPLBase64DecodeInPlace(reinterpret_cast<GByte*>(bytes.data()));
    const std::string path = "/vsimem/preview_test";
    VSIFCloseL(VSIFileFromMemBuffer(path.c_str(), reinterpret_cast<GByte*>(bytes.data()),
                                    static_cast<vsi_l_offset>(count), FALSE));
    {
      const DatasetHandle read(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
      ASSERT_NE(read, nullptr);
      std::array<uint8_t, 3> pixel{};
      ASSERT_EQ(read->RasterIO(GF_Read, 30, 15, 1, 1, pixel.data(), 1, 1, GDT_Byte, 3, nullptr, 3, 3, 1, nullptr),
                CE_None);
      EXPECT_NEAR(pixel[0], 150, tolerance);
      EXPECT_NEAR(pixel[1], 150, tolerance);
      EXPECT_NEAR(pixel[2], 99, tolerance);
    }
    VSIUnlink(path.c_str());
  }
}

TEST(HeightHistogram, CountsThePostsOfTheFinestPages) {
  const std::string folder = FreshFolder("histogram");
  // The west at 100 m, the east at 900 m; fine ground in the west.
  const auto halves = [](int, int column, int) { return column < 180 ? 100.0 : 900.0; };
  Write(folder + "/halves.tif", {.width = 360, .height = 180, .affine = Degrees(-180, 90, 1), .value = halves});
  Write(folder + "/fine.tif",
        {.width = 20, .height = 20, .affine = Degrees(-100, 20, 0.1), .value = [](int, int, int) { return 100.0; }});
  MustBuild(folder, Layer("elevation", {"path = \"halves.tif\"\ndatum = \"ellipsoid\"",
                                        "path = \"fine.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  const auto all = CountHeights(*dataset, 0, 1 << 20, 10);
  ASSERT_TRUE(all.ok()) << all.message();
  EXPECT_EQ(all->pages_read, all->pages);
  const auto nodes = dataset->Nodes(0);
  EXPECT_EQ(all->pages, std::count_if(nodes.begin(), nodes.end(), [&](uint64_t word) {
              const Quadcode node = *Quadcode::FromWord(word);
              return dataset->FinestContaining(0, node.Box().south_deg, node.Box().west_deg) == node;
            }));
  EXPECT_LT(all->pages, static_cast<int64_t>(nodes.size()));
  EXPECT_EQ(all->step_m, 100);
  EXPECT_NEAR(all->lowest_m, 100, 0.1);
  EXPECT_NEAR(all->highest_m, 900, 0.1);
  ASSERT_LE(all->posts.size(), 10u);
  const int64_t posts = std::accumulate(all->posts.begin(), all->posts.end(), int64_t{0});
  EXPECT_EQ(posts, all->pages * kCells * kCells) << "none twice";
  EXPECT_GT(all->posts.front() + all->posts[1], posts / 2) << "more pages in the west";
  const auto some = CountHeights(*dataset, 0, 5, 10);
  ASSERT_TRUE(some.ok());
  EXPECT_EQ(some->pages_read, 5);
  EXPECT_EQ(some->pages, all->pages);
  EXPECT_EQ(std::accumulate(some->posts.begin(), some->posts.end(), int64_t{0}), 5 * kCells * kCells);
}

}  // namespace
}  // namespace belvedere

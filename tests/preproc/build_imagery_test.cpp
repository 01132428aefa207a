// Builds of imagery: what a source's pixels become, and layers that change with the time.
#include "preproc/build.h"

#include "preproc/report.h"
#include "tests/preproc/built_pages.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;

TEST(BuildImagery, ImageryHonoursAlphaMaskAndPalette) {
  const std::string folder = FreshFolder("alpha");
  const auto red = [](int band, int, int) { return band == 1 ? 200.0 : 10.0; };
  Write(folder + "/red.tif",
        {.width = 720, .height = 360, .bands = 3, .type = GDT_Byte, .affine = Degrees(-180, 90, 0.5), .value = red});
  Write(folder + "/alpha.tif",
        {.width = 200,
         .height = 200,
         .bands = 4,
         .type = GDT_Byte,
         .affine = Degrees(0, 20, 0.1),
         .value = [](int band, int column,
                     int) { return band == 4   ? (column < 100 ? 128.0 : 0.0)
                                   : band == 3 ? 250.0
                                               : 0.0; },
         .finish = [](GDALDataset& d) { d.GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand); }});
  Write(folder + "/palette.tif", {.width = 200,
                                  .height = 200,
                                  .type = GDT_Byte,
                                  .affine = Degrees(30, 20, 0.1),
                                  .value = [](int, int, int) { return 7.0; },
                                  .finish =
                                      [](GDALDataset& d) {
                                        GDALColorTable table;
                                        const GDALColorEntry green{0, 222, 0, 255};
                                        table.SetColorEntry(7, &green);
                                        d.GetRasterBand(1)->SetColorTable(&table);
                                      }});
  Write(folder + "/masked.tif", {.width = 200,
                                 .height = 200,
                                 .bands = 3,
                                 .type = GDT_Byte,
                                 .affine = Degrees(60, 20, 0.1),
                                 .value = [](int, int column, int) { return column < 100 ? 99.0 : 0.0; },
                                 .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(0); }});
  MustBuild(folder, Layer("imagery", {"path = \"red.tif\"", "path = \"alpha.tif\"", "path = \"palette.tif\"",
                                      "path = \"masked.tif\""}));
  const auto dataset = MustOpen(folder);
  const auto blended = TexelAt(*dataset, 10, 5);
  EXPECT_NEAR(blended[0], 100, 2);
  EXPECT_NEAR(blended[2], 130, 2);
  EXPECT_EQ(blended[3], 255);
  EXPECT_EQ(TexelAt(*dataset, 10, 15), (std::array<int, 4>{200, 10, 10, 255}));
  EXPECT_EQ(TexelAt(*dataset, 10, 40), (std::array<int, 4>{0, 222, 0, 255}));
  EXPECT_EQ(TexelAt(*dataset, 10, 65), (std::array<int, 4>{99, 99, 99, 255}));
  EXPECT_EQ(TexelAt(*dataset, 10, 75), (std::array<int, 4>{200, 10, 10, 255}));
}

TEST(BuildImagery, NothingAliasesAndOutsideIsTransparent) {
  const std::string folder = FreshFolder("checker");
  Write(folder + "/board.tif",
        {.width = 1024,
         .height = 1024,
         .bands = 3,
         .type = GDT_Byte,
         .affine = Degrees(5, 35, 0.02),
         .value = [](int, int column, int row) { return (column + row) % 2 == 0 ? 255.0 : 0.0; }});
  MustBuild(folder, Layer("imagery", {"path = \"board.tif\""}));
  const auto dataset = MustOpen(folder);
  EXPECT_GE(dataset->MaxLevel(0), 4);
  for (int level = 0; level <= dataset->MaxLevel(0) - 2; ++level) {
    for (double at = 10; at < 20; at += 0.37) {
      const auto texel = TexelAt(*dataset, at + 10, at, level);
      EXPECT_NEAR(texel[0], 127.5, 4) << "level " << level;
      EXPECT_EQ(texel[3], 255);
    }
  }
  EXPECT_EQ(TexelAt(*dataset, -30, -100), (std::array<int, 4>{0, 0, 0, 0}));
}

TEST(BuildImagery, GuttersRepeatTheNeighbours) {
  const std::string folder = FreshFolder("gutter");
  std::mt19937 random(5);
  Write(folder + "/noise.tif", {.width = 720,
                                .height = 360,
                                .bands = 3,
                                .type = GDT_Byte,
                                .affine = Degrees(-180, 90, 0.5),
                                .value = [&](int, int, int) { return static_cast<double>(random() % 256); }});
  MustBuild(folder, Layer("imagery", {"path = \"noise.tif\""}));
  const auto dataset = MustOpen(folder);
  for (const uint64_t word : dataset->Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    const Quadcode east = Quadcode::FromColumnRow(node.level(), node.column() + 1, node.row());
    const auto own = dataset->ReadImage(0, node);
    const auto theirs = dataset->ReadImage(0, east);
    ASSERT_TRUE(own.ok() && theirs.ok());
    for (int row = 0; row < kImageSide; ++row) {
      const auto* a = &(*own)->texels[static_cast<size_t>(4 * (row * kImageSide + kImageInner))];
      const auto* b = &(*theirs)->texels[static_cast<size_t>(4 * row * kImageSide)];
      ASSERT_TRUE(std::equal(a, a + 4 * 2 * kImageGutter, b)) << node.ToString() << " row " << row;
    }
  }
}

// One grey over the whole Earth.
std::string Grey(const std::string& path, double value) {
  return Write(
      path, {.width = 36, .height = 18, .type = GDT_Byte, .affine = Degrees(-180, 90, 10), .value = [=](int, int, int) {
               return value;
             }});
}

TEST(BuildImagery, EachTimeOfALayerIsBuiltOverWhatHasNone) {
  const std::string folder = FreshFolder("times");
  Grey(folder + "/under.tif", 10);
  // The two months cover the west alone.
  for (const auto& [name, value] : {std::pair{"january", 100.0}, std::pair{"july", 200.0}}) {
    Write(folder + "/" + name + ".tif", {.width = 18,
                                         .height = 18,
                                         .type = GDT_Byte,
                                         .affine = Degrees(-180, 90, 10),
                                         .value = [value = value](int, int, int) { return value; }});
  }
  const std::string text =
      "[[layer]]\nname = \"seasons\"\nkind = \"imagery\"\nrepeats = \"year\"\n"
      "[[layer.source]]\npath = \"july.tif\"\ntime = \"2004-07-01\"\n"
      "[[layer.source]]\npath = \"january.tif\"\ntime = \"2004-01-01\"\n"
      "[[layer.source]]\npath = \"gone.tif\"\ntime = \"2004-10-01\"\n"
      "[[layer.source]]\npath = \"under.tif\"\n";
  const auto report = MustBuild(folder, text);
  ASSERT_EQ(report.skipped.size(), 1u);
  EXPECT_EQ(report.skipped[0].source, "gone.tif");
  EXPECT_TRUE(report.warnings.empty());
  const auto dataset = MustOpen(folder);
  ASSERT_EQ(dataset->layers().size(), 2u) << "without its source October is no step";
  const auto grey_at = [&](int layer, double longitude) {
    const auto page = dataset->ReadImage(layer, Quadcode::Containing(20, longitude, 0));
    EXPECT_TRUE(page.ok());
    return static_cast<int>((*page)->texels[static_cast<size_t>(4 * (kImageSide * kImageSide / 2 + kImageSide / 2))]);
  };
  EXPECT_EQ(dataset->layers()[0].name, "seasons@2004-01-01T00:00:00Z");
  EXPECT_EQ(grey_at(0, -100), 100);
  EXPECT_EQ(grey_at(1, -100), 200);
  EXPECT_EQ(grey_at(0, 100), 10) << "under every time lies what has none";
  EXPECT_EQ(grey_at(1, 100), 10);
  ASSERT_TRUE(dataset->layers()[1].step);
  EXPECT_EQ(dataset->layers()[1].step->layer, "seasons");
  EXPECT_TRUE(VerifyDataset(*dataset).problems.empty());

  const std::string shown = DescribeDataset(*dataset);
  EXPECT_NE(shown.find("step of layer seasons, from 2004-07-01T00:00:00Z on, every year"), std::string::npos) << shown;
  EXPECT_NE(shown.find("source july.tif"), std::string::npos) << shown;
  EXPECT_NE(shown.find(", time 2004-07-01T00:00:00Z"), std::string::npos) << shown;
  const std::string json = DescribeDatasetJson(*dataset);
  EXPECT_NE(json.find("\"step_of\": \"seasons\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"time\": \"2004-01-01T00:00:00Z\""), std::string::npos) << json;
}

TEST(BuildImagery, WhatIsHiddenInOneStepAndSeenInAnotherIsNoMistake) {
  const std::string folder = FreshFolder("hidden");
  Grey(folder + "/under.tif", 10);
  Grey(folder + "/whole.tif", 100);
  Write(folder + "/half.tif",
        {.width = 18, .height = 18, .type = GDT_Byte, .affine = Degrees(-180, 90, 10), .value = [](int, int, int) {
           return 200.0;
         }});
  const auto spec = [](const std::string& second) {
    return Layer("imagery", {"path = \"under.tif\"", "path = \"whole.tif\"\ntime = \"2004-01-01\"",
                             "path = \"" + second + "\"\ntime = \"2005-01-01\""});
  };
  EXPECT_TRUE(MustBuild(folder, spec("half.tif")).warnings.empty());
  const auto report = MustBuild(folder, spec("whole.tif"));
  ASSERT_EQ(report.warnings.size(), 1u) << "said once, not of every step";
  EXPECT_EQ(report.warnings[0].source, "under.tif");
}

// What a grey overlay is made of: alpha and nodata are where what lies under it is seen.
TEST(BuildImagery, GreySourcesKeepTheirAlphaAndNodata) {
  const std::string folder = FreshFolder("greys");
  const auto alpha = [](GDALDataset& d) { d.GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand); };
  const auto half_west = [](double grey, double whole) {
    return [=](int band, int column, int) {
      return band == 1 ? grey : column < 50 ? whole : column < 100 ? whole / 2 : 0;
    };
  };
  const MadeRaster two{
      .width = 200, .height = 200, .bands = 2, .affine = Degrees(0, 20, 0.1), .value = {}, .finish = alpha};
  MadeRaster eight = two, sixteen = two, bare = two, one = two;
  eight.type = GDT_Byte;
  eight.value = half_west(180, 255);
  sixteen.type = GDT_UInt16;
  sixteen.affine = Degrees(30, 20, 0.1);
  // From 0 in the north to 65535 in the south.
  sixteen.value = [whole = half_west(0, 65'535)](int band, int column, int row) {
    return band == 1 ? row * 65'535.0 / 199 : whole(band, column, row);
  };
  one.type = GDT_Byte;
  one.bands = 1;
  one.affine = Degrees(60, 20, 0.1);
  one.value = [](int, int column, int) { return column < 100 ? 90.0 : 255.0; };
  one.finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(255); };
  bare.type = GDT_Byte;
  bare.affine = Degrees(90, 20, 0.1);
  bare.value = half_west(70, 255);
  bare.finish = [](GDALDataset&) {};
  std::vector<std::string> sources;
  for (const auto& [name, made] : {std::pair{"eight", &eight}, {"sixteen", &sixteen}, {"one", &one}, {"bare", &bare}}) {
    Write(folder + "/" + name + ".tif", *made);
    sources.push_back("path = \"" + std::string(name) + ".tif\"");
  }
  const auto report = MustBuild(folder, Layer("imagery", sources));
  EXPECT_TRUE(report.skipped.empty());
  const auto dataset = MustOpen(folder);
  using Rgba = std::array<int, 4>;
  EXPECT_EQ(TexelAt(*dataset, 10, 2), (Rgba{180, 180, 180, 255}));
  EXPECT_EQ(TexelAt(*dataset, 10, 7.5), (Rgba{180, 180, 180, 128}));
  EXPECT_EQ(TexelAt(*dataset, 10, 15), (Rgba{0, 0, 0, 0}));
  const Rgba middle = TexelAt(*dataset, 10, 32);
  EXPECT_NEAR(middle[0], 140, 15) << "stretched from about its range";
  EXPECT_EQ(middle[2], middle[0]);
  EXPECT_EQ(middle[3], 255);
  EXPECT_EQ(TexelAt(*dataset, 10, 37.5)[3], 128);
  EXPECT_EQ(TexelAt(*dataset, 10, 45), (Rgba{0, 0, 0, 0}));
  EXPECT_EQ(TexelAt(*dataset, 10, 65), (Rgba{90, 90, 90, 255}));
  EXPECT_EQ(TexelAt(*dataset, 10, 75), (Rgba{0, 0, 0, 0}));
  EXPECT_EQ(TexelAt(*dataset, 10, 105), (Rgba{70, 70, 70, 255}));
  const auto said = std::find_if(report.warnings.begin(), report.warnings.end(),
                                 [](const SourceRemark& remark) { return remark.source == "bare.tif"; });
  ASSERT_NE(said, report.warnings.end());
  EXPECT_NE(said->reason.find("not said to be alpha"), std::string::npos) << said->reason;
}

}  // namespace
}  // namespace belvedere

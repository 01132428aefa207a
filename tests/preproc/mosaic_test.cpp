// Files that a folder or a pattern names make the pages of the raster that they were cut from.

#include "preproc/mosaic.h"

#include "preproc/report.h"
#include "preproc/update.h"
#include "tests/preproc/built_pages.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

constexpr int kSide = 128;       // of the whole raster, in pixels
constexpr double kPixel = 0.02;  // degrees

double NoiseAt(int band, int column, int row) {
  return (column * 7919 + row * 104729 + band * 31) % 251;
}

// The part of the whole raster that starts at that pixel.
void WritePart(const std::string& path, int column, int row, int width, int height, int bands, GDALDataType type) {
  Write(path, {.width = width,
               .height = height,
               .bands = bands,
               .type = type,
               .affine = Degrees(10 + column * kPixel, 50 - row * kPixel, kPixel),
               .value = [=](int band, int x, int y) { return NoiseAt(band, column + x, row + y); }});
}

// Heights and colours, whole and in parts.
std::string Prepare(const std::string& name) {
  const std::string folder = fs::path(FreshFolder(name)).lexically_normal();
  fs::create_directories(folder + "/heights/north");
  fs::create_directories(folder + "/colours");
  WritePart(folder + "/heights.tif", 0, 0, kSide, kSide, 1, GDT_Int16);
  WritePart(folder + "/colours.tif", 0, 0, kSide, kSide, 3, GDT_Byte);
  int number = 0;
  for (const int row : {0, 50}) {
    for (const int column : {0, 70}) {
      const int width = column == 0 ? 70 : kSide - 70;
      const int height = row == 0 ? 50 : kSide - 50;
      const std::string tile = "tile" + std::to_string(number++) + ".tif";
      WritePart(folder + "/heights/" + (row == 0 ? "north/" : "") + tile, column, row, width, height, 1, GDT_Int16);
      WritePart(folder + "/colours/" + tile, column, row, width, height, 3, GDT_Byte);
    }
  }
  return folder;
}

uint32_t DigestOf(const std::string& folder) {
  const auto dataset = MustOpen(folder);
  if (dataset == nullptr) return 0;
  const Verification found = VerifyDataset(*dataset);
  EXPECT_TRUE(found.problems.empty());
  return found.digest;
}

SourceSpec Source(const std::string& path) {
  SourceSpec source;
  source.path = source.written_path = path;
  return source;
}

TEST(Mosaic, PartsMakeThePagesOfTheWhole) {
  const std::string folder = Prepare("mosaic_parts");
  MustBuild(folder, Layer("elevation", {"path = \"heights.tif\"\nfeather_m = 9000"}) +
                        Layer("imagery", {"path = \"colours.tif\"\nfeather_m = 9000"}));
  const uint32_t whole = DigestOf(folder);
  std::ofstream(folder + "/heights/README.txt") << "not a raster";
  std::ofstream(folder + "/heights/tile0.tif.aux.xml") << "<PAMDataset/>";
  const auto report = MustBuild(folder, Layer("elevation", {"path = \"heights\"\nfeather_m = 9000"}) +
                                            Layer("imagery", {"path = \"colours/tile?.tif\"\nfeather_m = 9000"}));
  EXPECT_TRUE(report.skipped.empty());
  EXPECT_TRUE(report.warnings.empty());
  ASSERT_EQ(report.layers.size(), 2U);
  ASSERT_EQ(report.layers[0].sources.size(), 1U);
  EXPECT_EQ(report.layers[0].sources[0].path, "heights");
  EXPECT_EQ(report.layers[0].sources[0].extent.east_deg, 10 + kSide * kPixel);
  EXPECT_EQ(DigestOf(folder), whole);
}

TEST(Mosaic, PatternsNameWhatAShellsWould) {
  const std::string folder = Prepare("mosaic_patterns");
  const auto names = [&](const std::string& pattern) {
    std::vector<std::string> found;
    const auto files = FilesOf(folder + "/" + pattern);
    EXPECT_TRUE(files.ok()) << files.message();
    for (const std::string& file : *files) found.push_back(file.substr(folder.size() + 1));
    return found;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("*.tif"), (Names{"colours.tif", "heights.tif"}));
  EXPECT_EQ(names("heights/*.tif"), (Names{"heights/tile2.tif", "heights/tile3.tif"}));
  EXPECT_EQ(names("heights/*/tile[13].tif"), (Names{"heights/north/tile1.tif"}));
  EXPECT_EQ(names("heights/**/*.tif"),
            (Names{"heights/north/tile0.tif", "heights/north/tile1.tif", "heights/tile2.tif", "heights/tile3.tif"}));
  EXPECT_EQ(names("*/tile2.tif"), (Names{"colours/tile2.tif", "heights/tile2.tif"}));
  EXPECT_EQ(names("colours"), names("colours/*"));
  EXPECT_TRUE(names("*.png").empty());
  EXPECT_FALSE(FilesOf(folder + "/none/*.tif").ok());
  EXPECT_TRUE(IsPattern(folder + "/colours"));
  EXPECT_TRUE(IsPattern("tiles/*.tif"));
  EXPECT_FALSE(IsPattern(folder + "/colours.tif"));
  EXPECT_FALSE(IsPattern("https://a.b/{z}/{x}/{y}.png?key=*"));
  EXPECT_FALSE(IsPattern("/vsizip/a*.zip"));
  // A file that has such a name is that file.
  WritePart(folder + "/a[1].tif", 0, 0, 4, 4, 1, GDT_Int16);
  EXPECT_FALSE(IsPattern(folder + "/a[1].tif"));
}

TEST(Mosaic, FilesOfDifferentGridsAreSourcesOfTheirOwn) {
  const std::string folder = fs::path(FreshFolder("mosaic_grids")).lexically_normal();
  fs::create_directories(folder + "/t");
  const auto flat = [&](const std::string& name, double value, const std::array<double, 6>& affine, int epsg,
                        GDALDataType type = GDT_Int16) {
    Write(folder + "/t/" + name,
          {.width = 40, .height = 40, .type = type, .affine = affine, .epsg = epsg, .value = [=](int, int, int) {
             return value;
           }});
  };
  flat("a.tif", 100, Degrees(10, 50, 0.02), 4326);
  flat("b.tif", 200, Degrees(10.8, 50, 0.02), 4326);                  // beside a
  flat("c.tif", 300, Degrees(12.009, 50, 0.02), 4326);                // between its pixels
  flat("d.tif", 400, Degrees(14, 50, 0.02), 4326, GDT_Float32);       // of another type
  flat("e.tif", 500, {500000, 900, 0, 4900000, 0, -900}, 32632);      // of another CRS
  flat("f.tif", 600, {500000, 900, 100, 4800000, 100, -900}, 32632);  // turned
  std::ofstream(folder + "/t/g.tif") << "II*" << '\0' << "cut short";
  const auto report = MustBuild(folder, Layer("elevation", {"path = \"t/*.tif\"\ndatum = \"ellipsoid\""}));
  ASSERT_EQ(report.layers.size(), 1U);
  EXPECT_EQ(report.layers[0].sources.size(), 5U);
  ASSERT_EQ(report.skipped.size(), 1U);
  EXPECT_EQ(report.skipped[0].source, folder + "/t/g.tif");
  const auto dataset = MustOpen(folder);
  EXPECT_NEAR(HeightAt(*dataset, 49.6, 10.4), 100, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 49.6, 11.2), 200, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 49.6, 12.4), 300, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 49.6, 14.4), 400, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 44.1, 9.2), 500, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 43.2, 9.25), 600, 0.1);

  const auto mosaics = MosaicsOf(Source(folder + "/t"));
  ASSERT_TRUE(mosaics.ok()) << mosaics.message();
  std::vector<std::string> labels;
  for (const SourceSpec& source : mosaics->sources) labels.push_back(source.tiles);
  EXPECT_EQ(labels,
            (std::vector<std::string>{"EPSG:4326, 0.02 x 0.02, Int16", "EPSG:4326, 0.02 x 0.02, Int16, 2",
                                      "EPSG:4326, 0.02 x 0.02, Float32", "EPSG:32632, 900 x 900, Int16", "t/f.tif"}));
  EXPECT_EQ(mosaics->sources[0].files, (std::vector<std::string>{folder + "/t/a.tif", folder + "/t/b.tif"}));
}

TEST(Mosaic, BetweenFilesLiesWhatIsBelow) {
  const std::string folder = FreshFolder("mosaic_gap");
  fs::create_directories(folder + "/t");
  fs::create_directories(folder + "/c");
  Write(folder + "/below.tif",
        {.width = 36, .height = 18, .affine = Degrees(-180, 90, 10), .value = [](int, int, int) { return 77.0; }});
  for (const double west : {10.0, 12.0}) {
    Write(folder + "/t/" + std::to_string(west) + ".tif",
          {.width = 50, .height = 50, .type = GDT_Int16, .affine = Degrees(west, 50, 0.02), .value = [](int, int, int) {
             return 500.0;
           }});
    Write(folder + "/c/" + std::to_string(west) + ".tif", {.width = 50,
                                                           .height = 50,
                                                           .bands = 3,
                                                           .type = GDT_Byte,
                                                           .affine = Degrees(west, 50, 0.02),
                                                           .value = [](int, int, int) { return 200.0; }});
  }
  MustBuild(folder, Layer("elevation",
                          {"path = \"below.tif\"\ndatum = \"ellipsoid\"", "path = \"t/*\"\ndatum = \"ellipsoid\""}));
  auto dataset = MustOpen(folder);
  EXPECT_NEAR(HeightAt(*dataset, 49.5, 10.5), 500, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 49.5, 12.5), 500, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 49.5, 11.5), 77, 0.1);
  MustBuild(folder, Layer("imagery", {"path = \"c\""}));
  dataset = MustOpen(folder);
  EXPECT_EQ(TexelAt(*dataset, 49.5, 10.5), (std::array{200, 200, 200, 255}));
  EXPECT_EQ(TexelAt(*dataset, 49.5, 11.5)[3], 0);
}

TEST(Mosaic, HeightsHaveTheirMaskAndAlpha) {
  const std::string folder = FreshFolder("mosaic_alpha");
  Write(folder + "/alpha.tif",
        {.width = 50,
         .height = 50,
         .bands = 2,
         .affine = Degrees(10, 50, 0.02),
         .value = [](int band, int column, int) { return band == 1     ? 500.0
                                                         : column < 25 ? 255.0
                                                                       : 0.0; },
         .finish = [](GDALDataset& dataset) { dataset.GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand); }});
  Write(folder + "/below.tif",
        {.width = 36, .height = 18, .affine = Degrees(-180, 90, 10), .value = [](int, int, int) { return 77.0; }});
  MustBuild(folder, Layer("elevation", {"path = \"below.tif\"\ndatum = \"ellipsoid\"",
                                        "path = \"alpha.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  EXPECT_NEAR(HeightAt(*dataset, 49.5, 10.2), 500, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 49.5, 10.8), 77, 0.1);
}

TEST(Mosaic, AFileThatCameSinceIsTakenByAnUpdate) {
  const std::string folder = Prepare("mosaic_update");
  fs::rename(folder + "/heights/tile3.tif", folder + "/tile3.tif");
  const std::string spec = Layer("elevation", {"path = \"heights\""});
  MustBuild(folder, spec);
  const uint32_t before = DigestOf(folder);
  fs::rename(folder + "/tile3.tif", folder + "/heights/tile3.tif");
  BuildOptions options;
  options.out = folder + "/out";
  options.jobs = 2;
  options.show_progress = false;
  const auto report = Update([](BuildSpec known) -> Result<BuildSpec> { return known; }, options, Clock::System());
  ASSERT_TRUE(report.ok()) << report.message();
  EXPECT_GT(report->written, 0);
  const uint32_t updated = DigestOf(folder);
  EXPECT_NE(updated, before);
  MustBuild(folder, spec);
  EXPECT_EQ(DigestOf(folder), updated);
  // And one that brings another grid: a source more.
  Write(folder + "/heights/other.tif",
        {.width = 8, .height = 8, .affine = Degrees(30, 50, 0.05), .value = [](int, int, int) { return 9.0; }});
  const auto more = Update([](BuildSpec known) -> Result<BuildSpec> { return known; }, options, Clock::System());
  ASSERT_TRUE(more.ok()) << more.message();
  EXPECT_EQ(more->layers[0].sources.size(), 2U);
  const uint32_t with_other = DigestOf(folder);
  MustBuild(folder, spec);
  EXPECT_EQ(DigestOf(folder), with_other);
}

TEST(Mosaic, WhatCannotBeUsedIsSaid) {
  const std::string folder = FreshFolder("mosaic_bad");
  fs::create_directories(folder + "/empty");
  Write(folder + "/good.tif",
        {.width = 8, .height = 8, .affine = Degrees(30, 50, 0.05), .value = [](int, int, int) { return 9.0; }});
  const auto report =
      MustBuild(folder, Layer("elevation", {"path = \"good.tif\"", "path = \"empty\"", "path = \"none*.tif\"",
                                            "path = \"good*\"\ngeoreference = [0, 0, 1, 1]"}));
  ASSERT_EQ(report.skipped.size(), 3U);
  EXPECT_EQ(report.skipped[0].source, "empty");
  EXPECT_EQ(report.skipped[0].reason, "no file of it is a raster that GDAL knows");
  EXPECT_EQ(report.skipped[1].source, "none*.tif");
  EXPECT_NE(report.skipped[2].reason.find("georeference"), std::string::npos);
}

}  // namespace
}  // namespace belvedere

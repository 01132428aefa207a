#include "preproc/build.h"

#include "preproc/plan.h"
#include "preproc/report.h"
#include "runtime/earth/geoid.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;

// Random terrain over the whole Earth, the same for the same seed.
std::string Noise(const std::string& path, int width, double amplitude, unsigned seed) {
  std::mt19937 random(seed);
  return Write(
      path,
      {.width = width, .height = width / 2, .affine = Degrees(-180, 90, 360.0 / width), .value = [&](int, int, int) {
         return amplitude * (static_cast<double>(random()) / 4294967296.0 - 0.5);
       }});
}

std::string Flat(const std::string& path, double value, const std::array<double, 6>& affine, int width, int height) {
  return Write(path,
               {.width = width, .height = height, .affine = affine, .value = [=](int, int, int) { return value; }});
}

double HeightAt(const Dataset& dataset, double latitude, double longitude) {
  const Quadcode node = dataset.FinestContaining(0, latitude, longitude);
  const auto page = dataset.ReadElevation(0, node);
  EXPECT_TRUE(page.ok()) << page.message();
  return page.ok() ? BilinearHeight(**page, node, latitude, longitude) : 0;
}

std::array<int, 4> TexelAt(const Dataset& dataset, double latitude, double longitude, int max_level = kMaxLevel) {
  const Quadcode node = dataset.FinestContaining(0, latitude, longitude, max_level);
  const auto page = dataset.ReadImage(0, node);
  EXPECT_TRUE(page.ok()) << page.message();
  const GeoBox box = node.Box();
  const int column = kImageGutter + static_cast<int>((longitude - box.west_deg) / node.SizeDegrees() * kImageInner);
  const int row = kImageGutter + static_cast<int>((latitude - box.south_deg) / node.SizeDegrees() * kImageInner);
  const uint8_t* texel = &(*page)->texels[static_cast<size_t>(4 * (row * kImageSide + column))];
  return {texel[0], texel[1], texel[2], texel[3]};
}

double Geoid(double latitude, double longitude) {
  static const auto geoid = Geoid::LoadEgm96();
  EXPECT_TRUE(geoid.ok()) << geoid.message();
  return (*geoid)->Height(latitude, longitude);
}

// Every post that two pages of a level hold, aprons included, is the same in both.
void ExpectSharedPosts(const Dataset& dataset) {
  for (const uint64_t word : dataset.Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    const auto page = dataset.ReadElevation(0, node);
    ASSERT_TRUE(page.ok()) << page.message();
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
      if (node.row() + dy >= (int64_t{kTreeRows} << node.level())) continue;
      const Quadcode other = Quadcode::FromColumnRow(node.level(), node.column() + dx, node.row() + dy);
      if (!dataset.Exists(0, other)) continue;
      const auto theirs = dataset.ReadElevation(0, other);
      ASSERT_TRUE(theirs.ok());
      for (int row = dy * kCells - kApron; row < kPosts + kApron; ++row) {
        for (int column = dx * kCells - kApron; column < kPosts + kApron; ++column) {
          if (row - dy * kCells >= kPosts + kApron || column - dx * kCells >= kPosts + kApron) continue;
          ASSERT_EQ((*page)->at(column, row), (*theirs)->at(column - dx * kCells, row - dy * kCells))
              << node.ToString() << " " << other.ToString() << " " << column << " " << row;
        }
      }
    }
  }
}

TEST(Build, SharedPostsAreTheSameBitsEverywhere) {
  const std::string folder = FreshFolder("borders");
  Noise(folder + "/world.tif", 512, 2, 1);
  std::mt19937 random(2);
  // UTM, over the border of two trees (0 E is not one, 45 N is): 6 E to 12 E, about 45 N.
  Write(folder + "/utm.tif", {.width = 60,
                              .height = 60,
                              .affine = {400000, 10000, 0, 5300000, 0, -10000},
                              .epsg = 32632,
                              .value = [&](int, int, int) { return static_cast<double>(random() % 3000); }});
  // Over 180 E.
  Write(folder + "/seam.tif",
        {.width = 50, .height = 50, .affine = Degrees(179, -10, 0.04), .value = [&](int, int, int) {
           return static_cast<double>(random() % 500);
         }});
  const auto report =
      MustBuild(folder, Layer("elevation", {"path = \"world.tif\"", "path = \"utm.tif\"", "path = \"seam.tif\""}));
  EXPECT_TRUE(report.skipped.empty());
  const auto dataset = MustOpen(folder);
  EXPECT_GT(dataset->MaxLevel(0), 4);
  ExpectSharedPosts(*dataset);
  EXPECT_TRUE(dataset->Exists(0, Quadcode::Containing(-11, 179.5, 5)));
  EXPECT_TRUE(dataset->Exists(0, Quadcode::Containing(-11, -179.5, 5)));
  const Verification verification = VerifyDataset(*dataset);
  EXPECT_EQ(verification.pages, report.pages);
  for (const auto& problem : verification.problems) ADD_FAILURE() << problem;
}

TEST(Build, APoleHasOneHeightALevel) {
  const std::string folder = FreshFolder("poles");
  Noise(folder + "/world.tif", 256, 4000, 3);
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
  const auto dataset = MustOpen(folder);
  for (const int row : {0, kTreeRows - 1}) {
    const int pole_row = row == 0 ? 0 : kCells;
    const auto first = dataset->ReadElevation(0, Quadcode::FromColumnRow(0, 0, row));
    ASSERT_TRUE(first.ok());
    for (int column = 0; column < kTreeColumns; ++column) {
      const auto page = dataset->ReadElevation(0, Quadcode::FromColumnRow(0, column, row));
      ASSERT_TRUE(page.ok());
      for (int i = -kApron; i < kPosts + kApron; ++i) EXPECT_EQ((*page)->at(i, pole_row), (*first)->at(0, pole_row));
    }
  }
}

TEST(Build, TheGeoidIsAppliedOnce) {
  const std::string folder = FreshFolder("geoid");
  Flat(folder + "/low.tif", 100, Degrees(0, 40, 0.1), 100, 100);
  Flat(folder + "/cm.tif", 5000, Degrees(20, 40, 0.1), 100, 100);
  Flat(folder + "/own.tif", 100, Degrees(40, 40, 0.1), 100, 100);
  Flat(folder + "/ft.tif", 1000, Degrees(60, 40, 0.1), 100, 100);
  MustBuild(folder, Layer("elevation", {"path = \"low.tif\"", "path = \"cm.tif\"\nunit = \"cm\"\ndatum = \"ellipsoid\"",
                                        "path = \"own.tif\"\ndatum = -12.5", "path = \"ft.tif\"\nunit = \"ft\""}));
  const auto dataset = MustOpen(folder);
  // Between posts both are bilinear, but the geoid's own grid is coarser: 5 cm is what the two may differ by.
  EXPECT_NEAR(HeightAt(*dataset, 35, 5), 100 + Geoid(35, 5), 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 35, 25), 50, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 35, 45), 87.5, 0.1);
  EXPECT_NEAR(HeightAt(*dataset, 35, 65), 304.8 + Geoid(35, 65), 0.1);
  EXPECT_NEAR(HeightAt(*dataset, -22.5, -67.5), Geoid(-22.5, -67.5), 0.5) << "outside all sources is mean sea level";
}

TEST(Build, NodataOfTheFinerSourceShowsTheCoarser) {
  const std::string folder = FreshFolder("nodata");
  Flat(folder + "/coarse.tif", 10, Degrees(-180, 90, 1), 360, 180);
  Write(folder + "/fine.tif",
        {.width = 400, .height = 400, .affine = Degrees(10, 14, 0.01), .value = [](int, int column, int) {
           return column < 200 ? 500.0 : column < 300 ? -7777.0 : std::nan("");
         }});
  MustBuild(folder, Layer("elevation", {"path = \"coarse.tif\"\ndatum = \"ellipsoid\"",
                                        "path = \"fine.tif\"\nnodata = -7777\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  EXPECT_NEAR(HeightAt(*dataset, 12, 11), 500, 0.05);
  EXPECT_NEAR(HeightAt(*dataset, 12, 12.5), 10, 0.05);
  EXPECT_NEAR(HeightAt(*dataset, 12, 13.5), 10, 0.05);
  EXPECT_NEAR(HeightAt(*dataset, 12, 9), 10, 0.05);
  // No value between the two that neither has: nodata is not blended in.
  const Quadcode node = dataset->FinestContaining(0, 12, 12);
  const auto page = dataset->ReadElevation(0, node);
  ASSERT_TRUE(page.ok());
  for (const int32_t height_mm : (*page)->heights_mm)
    EXPECT_TRUE(std::abs(height_mm - 500000) < 50 || std::abs(height_mm - 10000) < 50);
}

TEST(Build, AFeatherBlendsOverItsDistance) {
  const std::string folder = FreshFolder("feather");
  Flat(folder + "/fine.tif", 1000, Degrees(0, 2, 0.01), 200, 200);
  MustBuild(folder, Layer("elevation", {"path = \"fine.tif\"\ndatum = \"ellipsoid\"\nfeather_m = 30000"}));
  const auto dataset = MustOpen(folder);
  EXPECT_NEAR(HeightAt(*dataset, 1, 1), 1000, 1);
  double before = 0;
  for (double longitude = 0.02; longitude < 0.26; longitude += 0.04) {
    const double height = HeightAt(*dataset, 1, longitude);
    EXPECT_GT(height, before) << longitude;
    before = height;
  }
  EXPECT_LT(HeightAt(*dataset, 1, 0.02), 250);
}

TEST(Build, EnlargingLeavesNoSteps) {
  const std::string folder = FreshFolder("ramp");
  Write(folder + "/ramp.tif",
        {.width = 360, .height = 180, .affine = Degrees(-180, 90, 1), .value = [](int, int column, int row) {
           return 10.0 * column + 3.0 * row;
         }});
  // Another source forces levels where the ramp is much enlarged.
  Write(folder + "/fine.tif", {.width = 10,
                               .height = 10,
                               .affine = Degrees(20, 20, 0.01),
                               .value = [](int, int, int) { return -1.0; },
                               .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-1); }});
  Write(folder + "/dot.tif", {.width = 10,
                              .height = 10,
                              .affine = Degrees(20, 20, 0.01),
                              .value = [](int, int column, int) { return column == 0 ? 2057.0 : -1.0; },
                              .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-1); }});
  const auto report =
      MustBuild(folder, Layer("elevation", {"path = \"ramp.tif\"\ndatum = \"ellipsoid\"", "path = \"fine.tif\"",
                                            "path = \"dot.tif\"\ndatum = \"ellipsoid\""}));
  ASSERT_EQ(report.skipped.size(), 1u) << "a source without a valid pixel";
  EXPECT_NE(report.skipped[0].reason.find("covers nothing"), std::string::npos);
  const auto dataset = MustOpen(folder);
  const Quadcode node = Quadcode::Containing(19.95, 20.3, 5);
  ASSERT_TRUE(dataset->Exists(0, node));
  const auto page = dataset->ReadElevation(0, node);
  ASSERT_TRUE(page.ok());
  const double per_post_mm = 10000.0 * node.SizeDegrees() / kCells;
  for (int row = 0; row < kPosts; row += 16) {
    for (int column = 70; column < kPosts - 1; ++column) {
      EXPECT_NEAR((*page)->at(column + 1, row) - (*page)->at(column, row), per_post_mm, 40);
    }
  }
}

TEST(Build, ImageryHonoursAlphaMaskAndPalette) {
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

TEST(Build, NothingAliasesAndOutsideIsTransparent) {
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

TEST(Build, GuttersRepeatTheNeighbours) {
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

TEST(Build, SiblingsExistTogetherWhereASourceLies) {
  const std::string folder = FreshFolder("siblings");
  Flat(folder + "/small.tif", 10, Degrees(11.2, 47.1, 0.001), 30, 30);
  MustBuild(folder, Layer("elevation", {"path = \"small.tif\""}));
  const auto dataset = MustOpen(folder);
  const int finest = FinestLevel(0.001, LayerKind::kElevation);
  EXPECT_EQ(dataset->MaxLevel(0), finest);
  EXPECT_EQ(dataset->layers()[0].pages_per_level[0], kTrees);
  for (const uint64_t word : dataset->Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    if (node.is_root()) continue;
    for (int which = 0; which < 4; ++which) EXPECT_TRUE(dataset->Exists(0, node.Parent().Child(which)));
    EXPECT_TRUE(Overlap(node.Parent().Box(), {11.2, 47.07, 11.23, 47.1}));
  }
  EXPECT_EQ(dataset->FinestContaining(0, 47.09, 11.21).level(), finest);
}

TEST(Build, TheSameOnOneWorkerAndOnMany) {
  const std::string one = FreshFolder("one"), many = FreshFolder("many");
  for (const std::string& folder : {one, many}) {
    Noise(folder + "/world.tif", 256, 3000, 9);
    MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}), folder == one ? 1 : 4);
  }
  const auto a = MustOpen(one), b = MustOpen(many);
  ASSERT_EQ(a->Nodes(0).size(), b->Nodes(0).size());
  for (const uint64_t word : a->Nodes(0))
    EXPECT_EQ(a->ReadRaw(0, *Quadcode::FromWord(word)), b->ReadRaw(0, *Quadcode::FromWord(word)));
}

TEST(Build, ErrorOfEveryPageBoundsItsChildren) {
  const std::string folder = FreshFolder("error");
  Noise(folder + "/world.tif", 256, 3000, 10);
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\""}));
  const auto dataset = MustOpen(folder);
  for (const uint64_t word : dataset->Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    const auto page = dataset->ReadElevation(0, node);
    ASSERT_TRUE(page.ok());
    if (!dataset->HasChildren(0, node)) {
      EXPECT_EQ((*page)->error_m, 0.0f);
      continue;
    }
    for (int which = 0; which < 4; ++which) {
      const auto child = dataset->ReadElevation(0, node.Child(which));
      ASSERT_TRUE(child.ok());
      for (int row = 0; row < kPosts; row += 2) {
        for (int column = 0; column < kPosts; column += 2) {
          const int at_parent = (*page)->at(which % 2 * kCells / 2 + column / 2, which / 2 * kCells / 2 + row / 2);
          EXPECT_LE(std::abs((*child)->at(column, row) - at_parent) / 1000.0,
                    static_cast<double>((*page)->error_m) - static_cast<double>((*child)->error_m) + 1e-3);
        }
      }
      EXPECT_LE((*page)->min_m, (*child)->min_m);
      EXPECT_GE((*page)->max_m, (*child)->max_m);
    }
  }
}

TEST(Build, BadSourcesAreSkippedByNameAndTheRestIsBuilt) {
  const std::string folder = FreshFolder("bad");
  Flat(folder + "/good.tif", 10, Degrees(0, 10, 0.1), 50, 50);
  Flat(folder + "/truncated.tif", 10, Degrees(0, 10, 0.05), 200, 200);
  std::filesystem::resize_file(folder + "/truncated.tif", std::filesystem::file_size(folder + "/truncated.tif") / 2);
  Write(folder + "/nowhere.tif", {.width = 9, .height = 9, .epsg = 0, .value = [](int, int, int) { return 1.0; }});
  Flat(folder + "/outside.tif", 1, Degrees(0, 500, 0.1), 10, 10);
  std::ofstream(folder + "/text.tif") << "not a raster";
  const std::vector<std::string> bad = {"missing.tif", "truncated.tif", "nowhere.tif", "outside.tif", "text.tif"};
  std::vector<std::string> sources = {"path = \"good.tif\""};
  for (const auto& name : bad) sources.push_back("path = \"" + name + "\"");
  const auto report = MustBuild(folder, Layer("elevation", sources));
  ASSERT_EQ(report.skipped.size(), bad.size());
  for (const auto& name : bad) {
    EXPECT_TRUE(std::any_of(report.skipped.begin(), report.skipped.end(), [&](const SourceRemark& r) {
      return r.source == name && !r.reason.empty();
    })) << name;
  }
  const auto dataset = MustOpen(folder);
  EXPECT_EQ(dataset->layers()[0].sources.size(), 1u);
  EXPECT_NEAR(HeightAt(*dataset, 7, 3), 10 + Geoid(7, 3), 0.1);
  const auto nothing = ParseSpec(Layer("elevation", {"path = \"missing.tif\""}), folder + "/spec.toml");
  ASSERT_TRUE(nothing.ok());
  BuildOptions options;
  options.out = folder + "/none";
  options.show_progress = false;
  const auto failed = Build(*nothing, options, Clock::System());
  ASSERT_FALSE(failed.ok());
  EXPECT_NE(failed.message().find("missing.tif"), std::string::npos) << failed.message();
}

TEST(Build, AGeoreferenceMayBeGiven) {
  const std::string folder = FreshFolder("georeference");
  const auto value = [](int, int column, int row) { return 100.0 * column + 10.0 * row; };
  Write(folder + "/bare.tif", {.width = 8, .height = 4, .epsg = 0, .value = value});
  // South-up: row 0 is the southernmost.
  Write(folder + "/south.tif", {.width = 8, .height = 4, .affine = {100, 1, 0, 10, 0, 1}, .value = value});
  // Rotated by a quarter turn: columns run north, rows run east.
  Write(folder + "/turned.tif", {.width = 8, .height = 4, .affine = {40, 0, 1, 30, 1, 0}, .value = value});
  MustBuild(folder, Layer("elevation", {"path = \"bare.tif\"\ngeoreference = [0, 10, 8, 14]\ndatum = \"ellipsoid\"",
                                        "path = \"south.tif\"\ndatum = \"ellipsoid\"",
                                        "path = \"turned.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  EXPECT_NEAR(HeightAt(*dataset, 13.5, 2.5), 200, 5);
  EXPECT_NEAR(HeightAt(*dataset, 10.5, 6.5), 630, 5);
  EXPECT_NEAR(HeightAt(*dataset, 10.5, 102.5), 200, 5);
  EXPECT_NEAR(HeightAt(*dataset, 13.5, 106.5), 630, 5);
  EXPECT_NEAR(HeightAt(*dataset, 32.5, 40.5), 200, 5);
  EXPECT_NEAR(HeightAt(*dataset, 36.5, 43.5), 630, 5);
}

// One grey over the whole Earth.
std::string Grey(const std::string& path, double value) {
  return Write(
      path, {.width = 36, .height = 18, .type = GDT_Byte, .affine = Degrees(-180, 90, 10), .value = [=](int, int, int) {
               return value;
             }});
}

TEST(Build, EachTimeOfALayerIsBuiltOverWhatHasNone) {
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

TEST(Build, WhatIsHiddenInOneStepAndSeenInAnotherIsNoMistake) {
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
TEST(Build, GreySourcesKeepTheirAlphaAndNodata) {
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

#include "preproc/build.h"

#include "preproc/plan.h"
#include "preproc/report.h"
#include "runtime/earth/geoid.h"
#include "tests/preproc/built_pages.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
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

double Geoid(double latitude, double longitude) {
  static const auto geoid = Geoid::LoadEgm96();
  EXPECT_TRUE(geoid.ok()) << geoid.message();
  return (*geoid)->Height(latitude, longitude);
}

TEST(Build, SharedPostsAreTheSameBitsEverywhere) {
  const std::string folder = FreshFolder("borders");
  Noise(folder + "/world.tif", 512, 2, 1);
  std::mt19937 random(2);
  // UTM, over the border of two trees (0 E is not one, 45 N is): 6 E to 12 E, about 45 N.
  Write(folder + "/utm.tif", {.width = 60,
                              .height = 60,
                              .type = GDT_Int16,  // rounded otherwise than what lies around it
                              .affine = {400000, 10000, 0, 5300000, 0, -10000},
                              .epsg = 32632,
                              .value = [&](int, int, int) { return static_cast<double>(random() % 3000); }});
  // Over 180 E.
  Write(folder + "/seam.tif",
        {.width = 100, .height = 100, .affine = Degrees(179, -10, 0.02), .value = [&](int, int, int) {
           return static_cast<double>(random() % 5000);
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

TEST(Build, HeightsAreRoundedToAQuarterOfWhatTheSourceTellsApart) {
  // A ramp, so fine that its level alone would round to 1 mm.
  const auto steps_mm = [](const std::string& name, GDALDataType type, double scale) {
    const std::string folder = FreshFolder(name);
    Write(folder + "/ramp.tif", {.width = 64,
                                 .height = 64,
                                 .type = type,
                                 .affine = Degrees(10, 20, 0.0003),
                                 .value = [](int, int column, int row) { return 3.0 * column + row; },
                                 .finish = [&](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetScale(scale); }});
    MustBuild(folder, Layer("elevation", {"path = \"ramp.tif\"\ndatum = \"ellipsoid\""}));
    const auto dataset = MustOpen(folder);
    const Quadcode node = dataset->FinestContaining(0, 19.99, 10.01);
    EXPECT_GE(node.level(), 10);
    const auto page = dataset->ReadElevation(0, node);
    EXPECT_TRUE(page.ok()) << page.message();
    int32_t common = 0;
    for (int row = 0; row < kPosts; ++row) {
      for (int column = 0; column < kPosts; ++column) {
        const double longitude = node.Box().west_deg + node.WidthDegrees() * column / kCells;
        const double latitude = node.Box().south_deg + node.HeightDegrees() * row / kCells;
        if (longitude < 10.002 || longitude > 10.017 || latitude > 19.998 || latitude < 19.983) continue;
        common = std::gcd(common, (*page)->at(column, row));
      }
    }
    return common;
  };
  EXPECT_EQ(steps_mm("metres", GDT_Int16, 1), 128);
  EXPECT_EQ(steps_mm("feet", GDT_Int16, 0.3048), 64);
  EXPECT_EQ(steps_mm("centimetres", GDT_Int32, 0.01), 2);
  EXPECT_EQ(steps_mm("float", GDT_Float32, 1), 1);
}

TEST(Build, BetweenPixelsHeightsFollowTheGroundsCurve) {
  // Ridges eight pixels apart. On their crests, between pixels, no height is above those of the source.
  constexpr double kPixel_deg = 0.01, kAmplitude_m = 1000;
  const auto ridges = [](double column) { return kAmplitude_m * std::sin(column * M_PI / 4); };
  const std::string folder = FreshFolder("ridges");
  Write(folder + "/ridges.tif",
        {.width = 128, .height = 128, .affine = Degrees(10, 20, kPixel_deg), .value = [&](int, int column, int) {
           return ridges(column + 0.5);
         }});
  MustBuild(folder, Layer("elevation", {"path = \"ridges.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  const Quadcode node = dataset->FinestContaining(0, 19.4, 10.6);
  EXPECT_EQ(node.level(), 6);
  const auto page = dataset->ReadElevation(0, node);
  ASSERT_TRUE(page.ok()) << page.message();
  double off_m = 0, off_of_lines_m = 0, highest_m = 0;
  for (int column = 0; column < kPosts; ++column) {
    const double along = (node.Box().west_deg + node.HeightDegrees() * column / kCells - 10) / kPixel_deg;
    const double west = std::floor(along - 0.5) + 0.5;
    const double line_m = ridges(west) + (along - west) * (ridges(west + 1) - ridges(west));
    const double height_m = (*page)->at(column, 60) / 1000.0;
    off_m += std::abs(height_m - ridges(along)) / kPosts;
    off_of_lines_m += std::abs(line_m - ridges(along)) / kPosts;
    highest_m = std::max(highest_m, height_m);
  }
  EXPECT_GT(off_of_lines_m, 25);
  EXPECT_LT(off_m, 0.6 * off_of_lines_m);
  EXPECT_NEAR(highest_m, ridges(2.5), 0.01);
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
  const double per_post_mm = 10000.0 * node.HeightDegrees() / kCells;
  for (int row = 0; row < kPosts; row += 16) {
    for (int column = 70; column < kPosts - 1; ++column) {
      EXPECT_NEAR((*page)->at(column + 1, row) - (*page)->at(column, row), per_post_mm, 40);
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
    for (const int which : node.Parent().Children()) EXPECT_TRUE(dataset->Exists(0, node.Parent().Child(which)));
    EXPECT_TRUE(Overlap(node.Parent().Box(), {11.2, 47.07, 11.23, 47.1}));
  }
  EXPECT_EQ(dataset->FinestContaining(0, 47.09, 11.21).level(), finest);
}

// Stripes along meridians, 0.3 degrees apart, under posts of a wide page 0.35 degrees apart and 0.09 along meridians.
TEST(Build, FiltersAreAsWideAlongParallelsAsPostsAreApart) {
  const std::string folder = FreshFolder("stripes");
  Write(folder + "/stripes.tif",
        {.width = 1200, .height = 300, .affine = Degrees(-10, 81, 0.05), .value = [](int, int column, int) {
           return column / 3 % 2 == 0 ? 0.0 : 1000.0;
         }});
  MustBuild(folder, Layer("elevation", {"path = \"stripes.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  const Quadcode node = Quadcode::Containing(70, 10, 2);
  ASSERT_EQ(node.WidthDegrees(), 45);
  const auto page = dataset->ReadElevation(0, node);
  ASSERT_TRUE(page.ok());
  for (int column = 8; column < kCells - 8; ++column) EXPECT_NEAR((*page)->at(column, 64) / 1000.0, 500, 250) << column;
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
    for (const int which : node.Children()) {
      const int columns = node.Child(which).GridWidth() == node.GridWidth() ? 1 : 2;  // of the child, one of the page's
      const auto child = dataset->ReadElevation(0, node.Child(which));
      ASSERT_TRUE(child.ok());
      for (int row = 0; row < kPosts; row += 2) {
        for (int column = 0; column < kPosts; column += 2) {
          const int at_parent =
              (*page)->at(which % 2 * kCells / 2 + column / columns, which / 2 * kCells / 2 + row / 2);
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
  EXPECT_EQ(report.rounds, 2) << "one more for what is damaged within; what cannot be opened costs none";
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

}  // namespace
}  // namespace belvedere

// Heights come to lie as far above the ellipsoid as their datum does, whoever says which that is.

#include "preproc/vertical_datum.h"

#include "preproc/report.h"
#include "tests/preproc/built_pages.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

constexpr double kHeight_m = 100;
constexpr double kLatitude = 49.5, kLongitude = 10.5;

double Egm96_m() {
  static const auto geoid = Geoid::LoadEgm96();
  EXPECT_TRUE(geoid.ok()) << geoid.message();
  return (*geoid)->Height(kLatitude, kLongitude);
}

// One degree of flat land about the place, in a CRS that GDAL knows by that name.
void WriteFlat(const std::string& path, const std::string& crs) {
  Write(path, {.width = 50,
               .height = 50,
               .affine = Degrees(10, 50, 0.02),
               .value = [](int, int, int) { return kHeight_m; },
               .finish =
                   [&](GDALDataset& dataset) {
                     OGRSpatialReference named;
                     EXPECT_EQ(named.SetFromUserInput(crs.c_str()), OGRERR_NONE) << crs;
                     named.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
                     dataset.SetSpatialRef(&named);
                   }});
}

double Plane(double latitude, double longitude) {
  return 20 + 0.5 * latitude - 0.25 * longitude;
}

// A geoid of GeographicLib's, one post a degree.
void WritePgm(const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << "P5\n# Geoid file in PGM format for the GeographicLib::Geoid class\n# Offset -108\n# Scale 0.003\n360 "
          "181\n65535\n";
  for (int latitude = 90; latitude >= -90; --latitude) {
    for (int longitude = 0; longitude < 360; ++longitude) {
      const auto value = static_cast<unsigned>(std::lrint((Plane(latitude, longitude) + 108) / 0.003));
      file.put(static_cast<char>(value >> 8));
      file.put(static_cast<char>(value & 255));
    }
  }
}

// A grid of 8 to 13 E and 48 to 51 N, ten posts a degree.
void WriteGrid(const std::string& path, double missing_east_of = 1000) {
  Write(path, {.width = 51,
               .height = 31,
               .affine = Degrees(7.95, 51.05, 0.1),
               .value =
                   [=](int, int column, int row) {
                     return 8 + 0.1 * column > missing_east_of ? -9999.0 : Plane(51 - 0.1 * row, 8 + 0.1 * column);
                   },
               .finish = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-9999); }});
}

struct Built {
  double height_m = 0;
  std::string datum;
  BuildReport report;
};

Built BuildWith(const std::string& folder, const std::string& file, const std::string& keys,
                double longitude = kLongitude) {
  Built built;
  built.report = MustBuild(folder, Layer("elevation", {"path = \"" + file + "\"\n" + keys}));
  const auto dataset = MustOpen(folder);
  if (dataset == nullptr) return built;
  built.height_m = HeightAt(*dataset, kLatitude, longitude);
  built.datum = dataset->layers()[0].sources[0].datum;
  return built;
}

TEST(VerticalDatum, AGridsFileLiftsTheHeights) {
  const std::string folder = FreshFolder("datum_file");
  WriteFlat(folder + "/flat.tif", "EPSG:4326");
  WritePgm(folder + "/geoid.pgm");
  WriteGrid(folder + "/grid.tif");
  const double expected = kHeight_m + Plane(kLatitude, kLongitude);
  EXPECT_NEAR(BuildWith(folder, "flat.tif", "datum = \"geoid.pgm\"").height_m, expected, 0.01);
  const Built built = BuildWith(folder, "flat.tif", "datum = \"grid.tif\"");
  EXPECT_NEAR(built.height_m, expected, 0.01);
  EXPECT_EQ(built.datum, folder + "/grid.tif");
  EXPECT_TRUE(built.report.warnings.empty());
}

TEST(VerticalDatum, OnlyWhatIsNeededOfAGridIsLoadedRoundTheEarthToo) {
  const std::string folder = FreshFolder("datum_part");
  WritePgm(folder + "/geoid.pgm");
  const auto part = LoadGeoidGrid(folder + "/geoid.pgm", {-1.5, 10, 1.5, 12});
  ASSERT_TRUE(part.ok()) << part.message();
  EXPECT_NEAR((*part)->Height(11.25, 1.25), Plane(11.25, 1.25), 0.01);
  EXPECT_NEAR((*part)->Height(11.25, -0.5), (Plane(11.25, 359) + Plane(11.25, 0)) / 2, 0.01);
  EXPECT_NEAR((*part)->Height(11.25, 358.5), Plane(11.25, 358.5), 0.01);
  EXPECT_TRUE(std::isnan((*part)->Height(11, 30)));
  EXPECT_TRUE(std::isnan((*part)->Height(30, 0)));
  const auto whole = LoadGeoidGrid(folder + "/geoid.pgm", {-180, -90, 180, 90});
  ASSERT_TRUE(whole.ok()) << whole.message();
  for (const double latitude : {-90.0, -33.3, 0.0, 89.9, 90.0})
    EXPECT_NEAR((*whole)->Height(latitude, 200.5), Plane(latitude, 200.5), 0.01) << latitude;
}

TEST(VerticalDatum, WhereTheGridHasNoValueTheSourceHasNone) {
  const std::string folder = FreshFolder("datum_hole");
  WriteFlat(folder + "/flat.tif", "EPSG:4326");
  WriteGrid(folder + "/grid.tif", 10.6);
  EXPECT_NEAR(BuildWith(folder, "flat.tif", "datum = \"grid.tif\"", 10.3).height_m, kHeight_m + Plane(kLatitude, 10.3),
              0.01);
  // Mean sea level, as where there is no source.
  const Built beyond = BuildWith(folder, "flat.tif", "datum = \"grid.tif\"", 10.8);
  EXPECT_NEAR(beyond.height_m, Egm96_m(), 1);
}

TEST(VerticalDatum, AVerticalCrsTakesProjsGrid) {
  const std::string folder = FreshFolder("datum_crs");
  WriteFlat(folder + "/flat.tif", "EPSG:4326");
  auto report =
      MustBuild(folder, Layer("elevation", {"path = \"flat.tif\"", "path = \"flat.tif\"\ndatum = \"EPSG:3855\"",
                                            "path = \"flat.tif\"\ndatum = \"EPSG:4326\""}));
  ASSERT_EQ(report.skipped.size(), 2U);
  EXPECT_NE(report.skipped[1].reason.find("no vertical CRS"), std::string::npos) << report.skipped[1].reason;
  EXPECT_NE(report.skipped[0].reason.find("us_nga_egm08_25"), std::string::npos) << report.skipped[0].reason;

  // EGM2008 as PROJ names it, in a folder where it looks.
  fs::create_directories(folder + "/proj");
  WriteGrid(folder + "/proj/us_nga_egm08_25.tif");
  setenv("PROJ_LIB", (folder + "/proj:/usr/share/proj").c_str(), 1);
  const Built built = BuildWith(folder, "flat.tif", "datum = \"EPSG:3855\"");
  EXPECT_NEAR(built.height_m, kHeight_m + Plane(kLatitude, kLongitude), 0.01);
  EXPECT_EQ(built.datum, "EPSG:3855");
  // And without a word in the spec where the file says it.
  WriteFlat(folder + "/declared.tif", "EPSG:4326+3855");
  EXPECT_EQ(BuildWith(folder, "declared.tif", "").datum, "EPSG:3855");
  unsetenv("PROJ_LIB");
}

TEST(VerticalDatum, WhatTheFileSaysHoldsUnlessTheSpecSaysOtherwise) {
  const std::string folder = FreshFolder("datum_declared");
  WriteFlat(folder + "/plain.tif", "EPSG:4326");
  WriteFlat(folder + "/ellipsoid.tif", "EPSG:4979");
  WriteFlat(folder + "/egm96.tif", "EPSG:4326+5773");
  WriteFlat(folder + "/navd88.tif", "EPSG:4326+5703");
  WriteFlat(folder + "/feet.tif", "EPSG:4326+6360");
  EXPECT_EQ(BuildWith(folder, "plain.tif", "").datum, "egm96");
  const Built ellipsoid = BuildWith(folder, "ellipsoid.tif", "");
  EXPECT_EQ(ellipsoid.datum, "ellipsoid");
  EXPECT_NEAR(ellipsoid.height_m, kHeight_m, 0.01);
  const Built egm96 = BuildWith(folder, "egm96.tif", "");
  EXPECT_EQ(egm96.datum, "egm96");
  EXPECT_NEAR(egm96.height_m, kHeight_m + Egm96_m(), 0.01);
  EXPECT_TRUE(egm96.report.warnings.empty());
  EXPECT_NEAR(BuildWith(folder, "ellipsoid.tif", "datum = 7").height_m, kHeight_m + 7, 0.01);
  // NAVD 88, for which Debian has no grid: said, and about right.
  const Built navd88 = BuildWith(folder, "navd88.tif", "");
  EXPECT_NEAR(navd88.height_m, kHeight_m + Egm96_m(), 0.01);
  ASSERT_EQ(navd88.report.warnings.size(), 1U);
  EXPECT_NE(navd88.report.warnings[0].reason.find("NAVD88 height"), std::string::npos);
  const Built feet = BuildWith(folder, "feet.tif", "");
  EXPECT_NEAR(feet.height_m, kHeight_m * 1200 / 3937 + Egm96_m(), 0.01);
  EXPECT_NEAR(BuildWith(folder, "feet.tif", "unit = \"m\"").height_m, kHeight_m + Egm96_m(), 0.01);
}

TEST(VerticalDatum, BadGridsAreRefused) {
  const std::string folder = FreshFolder("datum_bad");
  WriteGrid(folder + "/grid.tif");
  std::ofstream(folder + "/text.pgm") << "P5\n4 4\n65535\n";
  std::ofstream(folder + "/text.tif") << "nothing";
  const GeoBox box{10, 49, 11, 50};
  EXPECT_FALSE(LoadGeoidGrid(folder + "/none.gtx", box).ok());
  EXPECT_FALSE(LoadGeoidGrid(folder + "/text.pgm", box).ok());
  EXPECT_FALSE(LoadGeoidGrid(folder + "/text.tif", box).ok());
  EXPECT_NE(LoadGeoidGrid(folder + "/grid.tif", {100, 0, 101, 1}).message().find("does not reach"), std::string::npos);
  WritePgm(folder + "/short.pgm");
  fs::resize_file(folder + "/short.pgm", 2000);
  EXPECT_NE(LoadGeoidGrid(folder + "/short.pgm", box).message().find("cut short"), std::string::npos);
}

}  // namespace
}  // namespace belvedere

// Builds of layers whose sources overlap: which wins, and feathers along borders that are no rectangles.
#include "preproc/build.h"

#include "preproc/report.h"
#include "runtime/earth/ellipsoid.h"
#include "tests/preproc/built_pages.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;

constexpr double kNodata = -9999;

// About 60 N, where a degree of longitude is half as wide as one of latitude.
constexpr double kMiddleLatitude = 60, kMiddleLongitude = 2;
constexpr double kMetresNorth = 111'412, kMetresEast = 55'800;

// Distance on the ground from the middle, to some parts in a thousand.
double FromMiddle(double latitude, double longitude) {
  return std::hypot((latitude - kMiddleLatitude) * kMetresNorth, (longitude - kMiddleLongitude) * kMetresEast *
                                                                     std::cos(latitude * kRadiansPerDegree) /
                                                                     std::cos(kMiddleLatitude * kRadiansPerDegree));
}

double LatitudeOfRow(int row) {
  return 61 - 0.01 * (row + 0.5);
}
double LongitudeOfColumn(int column) {
  return 0.01 * (column + 0.5);
}
bool InDisc(int column, int row) {
  return FromMiddle(LatitudeOfRow(row), LongitudeOfColumn(column)) < 80'000;
}

MadeRaster Disc() {
  return {.width = 400,
          .height = 200,
          .affine = Degrees(0, 61, 0.01),
          .value = [](int, int column, int row) { return InDisc(column, row) ? 1000.0 : kNodata; },
          .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(kNodata); }};
}

double Smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

TEST(BuildLayering, AFeatherFollowsTheRealBorderInMetresOnTheGround) {
  const std::string folder = FreshFolder("disc");
  Write(folder + "/disc.tif", Disc());
  MustBuild(folder, Layer("elevation", {"path = \"disc.tif\"\ndatum = \"ellipsoid\"\nfeather_m = 20000"}));
  const auto dataset = MustOpen(folder);
  for (int azimuth = 0; azimuth < 360; azimuth += 15) {
    const double north = std::cos(azimuth * kRadiansPerDegree), east = std::sin(azimuth * kRadiansPerDegree);
    double before = 0;
    for (double inwards_m = 1500; inwards_m < 60'000; inwards_m += 1000) {
      const double latitude = kMiddleLatitude + (80'000 - inwards_m) * north / kMetresNorth;
      const double longitude = kMiddleLongitude + (80'000 - inwards_m) * east / kMetresEast *
                                                      std::cos(kMiddleLatitude * kRadiansPerDegree) /
                                                      std::cos(latitude * kRadiansPerDegree);
      const double height = HeightAt(*dataset, latitude, longitude);
      // Mean sea level, 40 m and more above the ellipsoid there, shines through; the border is a pixel's steps.
      EXPECT_NEAR(height, 1000 * Smooth(inwards_m / 20'000) + 45 * (1 - Smooth(inwards_m / 20'000)), 90)
          << azimuth << " " << inwards_m;
      EXPECT_LT(std::abs(height - before), 130) << "no step: " << azimuth << " " << inwards_m;
      before = height;
    }
  }
  ExpectSharedPosts(*dataset);
}

// An L in UTM, which no axis of the pages is parallel to, half of it made of small gaps.
TEST(BuildLayering, FeatheredPostsAreTheSameBitsInEveryPage) {
  const std::string folder = FreshFolder("ell");
  std::mt19937 random(4);
  Write(folder + "/ell.tif", {.width = 300,
                              .height = 300,
                              .affine = {400000, 500, 0, 5050000, 0, -500},
                              .epsg = 32632,
                              .value =
                                  [&](int, int column, int row) {
                                    const bool gap = column > 40 && column < 100 && random() % 400 == 0;
                                    return (column < 120 || row > 200) && !gap ? 2000.0 + column : kNodata;
                                  },
                              .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(kNodata); }});
  // Over 180 E, and so wide a feather that it is measured on a coarser level of the pyramid.
  Write(folder + "/seam.tif", {.width = 500,
                               .height = 400,
                               .affine = Degrees(179, -10, 0.005),
                               .value = [](int, int column, int row) { return column > row ? 500.0 : kNodata; },
                               .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(kNodata); }});
  MustBuild(folder,
            Layer("elevation", {"path = \"ell.tif\"\nfeather_m = 6000", "path = \"seam.tif\"\nfeather_m = 60000"}));
  const auto dataset = MustOpen(folder);
  EXPECT_GT(dataset->MaxLevel(0), 5);
  ExpectSharedPosts(*dataset);
}

// Over an inset's border no two posts differ by more than its feather's slope and the ground's.
TEST(BuildLayering, OverTheBorderOfAnInsetThereIsNoStepAtAnyLevel) {
  const std::string folder = FreshFolder("ring");
  const auto hills = [](double longitude, double latitude) {
    return 300 * std::sin(8 * longitude) * std::sin(8 * latitude);
  };
  Write(folder + "/below.tif",
        {.width = 300, .height = 200, .affine = Degrees(-1, 62, 0.02), .value = [&](int, int column, int row) {
           return hills(-1 + 0.02 * (column + 0.5), 62 - 0.02 * (row + 0.5));
         }});
  Write(folder + "/inset.tif", {.width = 400,
                                .height = 200,
                                .affine = Degrees(0, 61, 0.01),
                                .value =
                                    [&](int, int column, int row) {
                                      if (!InDisc(column, row)) return kNodata;
                                      return 150 + hills(LongitudeOfColumn(column), LatitudeOfRow(row));
                                    },
                                .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(kNodata); }});
  MustBuild(folder, Layer("elevation", {"path = \"below.tif\"\ndatum = \"ellipsoid\"",
                                        "path = \"inset.tif\"\ndatum = \"ellipsoid\"\nfeather_m = 20000"}));
  const auto dataset = MustOpen(folder);
  const int finest = dataset->FinestContaining(0, 60, 2).level();
  for (int level = finest - 3; level <= finest; ++level) {
    const double step_m = 500;
    // 300 m, 8 radians a degree; and 150 m, one and a half times as steep as their mean over 20 km.
    const double most = step_m * (std::hypot(300 * 8 / kMetresEast, 300 * 8 / kMetresNorth) + 1.5 * 150 / 20'000) + 2;
    for (const bool eastwards : {false, true}) {
      double before = 0;
      for (double from_m = -95'000; from_m < 95'000; from_m += step_m) {
        const double height = HeightAt(*dataset, kMiddleLatitude + (eastwards ? 0.1 : from_m / kMetresNorth),
                                       kMiddleLongitude + (eastwards ? from_m / kMetresEast : 0.1), level);
        if (from_m > -95'000) {
          EXPECT_LT(std::abs(height - before), most) << "level " << level << " at " << from_m;
        }
        before = height;
      }
    }
    EXPECT_NEAR(HeightAt(*dataset, kMiddleLatitude, kMiddleLongitude, level), 150 + hills(2, 60), 60);
  }
}

MadeRaster Colours(int bands, const std::function<double(int, int, int)>& value) {
  return {
      .width = 400, .height = 200, .bands = bands, .type = GDT_Byte, .affine = Degrees(0, 61, 0.01), .value = value};
}

// A disc of white on black by alpha, by mask and by nodata: the same picture.
TEST(BuildLayering, ImageryFadesAlongItsRealBorderHoweverThatIsGiven) {
  const auto white = [](int, int column, int row) { return InDisc(column, row) ? 200.0 : 0.0; };
  MadeRaster alpha = Colours(4, [](int band, int column, int row) {
    return band < 4 ? 200.0 : InDisc(column, row) ? 255.0 : 0.0;
  });
  alpha.finish = [](GDALDataset& d) { d.GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand); };
  MadeRaster nodata = Colours(3, white), mask = Colours(3, [](int, int, int) { return 200.0; });
  nodata.finish = [](GDALDataset& d) {
    for (int band = 1; band <= 3; ++band) d.GetRasterBand(band)->SetNoDataValue(0);
  };
  mask.finish = [](GDALDataset& d) {
    ASSERT_EQ(d.CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::vector<uint8_t> bytes;
    for (int row = 0; row < 200; ++row) {
      for (int column = 0; column < 400; ++column) bytes.push_back(InDisc(column, row) ? 255 : 0);
    }
    ASSERT_EQ(d.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 400, 200, bytes.data(), 400, 200, GDT_Byte, 0,
                                                          0, nullptr),
              CE_None);
  };
  for (const auto& [name, made] : {std::pair{"alpha", &alpha}, {"nodata", &nodata}, {"mask", &mask}}) {
    const std::string folder = FreshFolder("fade_" + std::string(name));
    Write(folder + "/disc.tif", *made);
    MustBuild(folder, Layer("imagery", {"path = \"disc.tif\"\nfeather_m = 20000"}));
    const auto dataset = MustOpen(folder);
    for (int azimuth = 0; azimuth < 360; azimuth += 45) {
      const double north = std::cos(azimuth * kRadiansPerDegree), east = std::sin(azimuth * kRadiansPerDegree);
      int before = 0;
      for (double inwards_m = -3000; inwards_m < 70'000; inwards_m += 500) {
        const double latitude = kMiddleLatitude + (80'000 - inwards_m) * north / kMetresNorth;
        const double longitude = kMiddleLongitude + (80'000 - inwards_m) * east / kMetresEast *
                                                        std::cos(kMiddleLatitude * kRadiansPerDegree) /
                                                        std::cos(latitude * kRadiansPerDegree);
        const auto texel = TexelAt(*dataset, latitude, longitude);
        const double expected = 255 * Smooth(inwards_m / 20'000);
        EXPECT_NEAR(texel[3], expected, 22) << name << " " << azimuth << " " << inwards_m;
        EXPECT_LT(std::abs(texel[3] - before), 26) << "a ring: " << name << " " << azimuth << " " << inwards_m;
        EXPECT_TRUE(texel[3] == 0 || std::abs(texel[0] - 200) <= 2) << "what is not valid has no colour";
        before = texel[3];
      }
    }
  }
}

TEST(BuildLayering, AFeatherLeavesWhatIsHalfTransparentAsItIs) {
  const std::string folder = FreshFolder("half");
  MadeRaster half = Colours(4, [](int band, int, int) { return band < 4 ? 90.0 : 100.0; });
  half.finish = [](GDALDataset& d) { d.GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand); };
  Write(folder + "/half.tif", half);
  MustBuild(folder, Layer("imagery", {"path = \"half.tif\"\nfeather_m = 20000"}));
  const auto dataset = MustOpen(folder);
  EXPECT_NEAR(TexelAt(*dataset, 60, 2)[3], 100, 1);
  EXPECT_NEAR(TexelAt(*dataset, 60, 10'000 / kMetresEast)[3], 50, 3);
}

TEST(BuildLayering, AFeatherGoesRoundOnePixelThatIsMissing) {
  const std::string folder = FreshFolder("pixel");
  MadeRaster grey = Colours(1, [](int, int column, int row) { return column == 200 && row == 100 ? 0.0 : 180.0; });
  grey.finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(0); };
  Write(folder + "/grey.tif", grey);
  MustBuild(folder, Layer("imagery", {"path = \"grey.tif\"\nfeather_m = 20000"}));
  const auto dataset = MustOpen(folder);
  EXPECT_LT(TexelAt(*dataset, LatitudeOfRow(98), LongitudeOfColumn(200))[3], 20);
  EXPECT_NEAR(TexelAt(*dataset, LatitudeOfRow(100) + 10'000 / kMetresNorth, LongitudeOfColumn(200))[3], 125, 12);
  EXPECT_EQ(TexelAt(*dataset, LatitudeOfRow(50), LongitudeOfColumn(200))[3], 255);
  for (int level = 0; level < 3; ++level) {
    EXPECT_GT(TexelAt(*dataset, 60.2, 1.6, level)[3], 200) << "one pixel does not hide a coarse one";
  }
}

// Pixels that are missing here and there, far smaller than the feather is wide.
TEST(BuildLayering, AWideFeatherDoesNotMindSpecks) {
  const std::string folder = FreshFolder("specks");
  MadeRaster grey =
      Colours(1, [](int, int column, int row) { return column % 23 == 11 && row % 19 == 9 ? 0.0 : 180.0; });
  grey.affine = Degrees(0, 60.2, 0.001);
  grey.finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(0); };
  Write(folder + "/grey.tif", grey);
  MustBuild(folder, Layer("imagery", {"path = \"grey.tif\"\nfeather_m = 8000"}));
  const auto dataset = MustOpen(folder);
  for (int level = 4; level <= dataset->MaxLevel(0); ++level)
    EXPECT_GT(TexelAt(*dataset, 60.1, 0.203, level)[3], 245) << "level " << level;
  EXPECT_NEAR(TexelAt(*dataset, 60.1, 4000 / kMetresEast)[3], 128, 14);
}

TEST(BuildLayering, WhatGoesRoundTheEarthHasNoBorderToFeather) {
  const std::string folder = FreshFolder("round");
  Write(folder + "/world.tif",
        {.width = 360, .height = 180, .affine = Degrees(-180, 90, 1), .value = [](int, int, int) { return 700.0; }});
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\"\ndatum = \"ellipsoid\"\nfeather_m = 300000"}));
  const auto dataset = MustOpen(folder);
  for (const double latitude : {-89.9, -45.0, 0.0, 89.9}) {
    EXPECT_NEAR(HeightAt(*dataset, latitude, 179.9), 700, 0.1) << latitude;
    EXPECT_NEAR(HeightAt(*dataset, latitude, 20), 700, 0.1) << latitude;
  }
}

TEST(BuildLayering, TheFinestSourceWinsWhereThatIsAskedFor) {
  const std::string folder = FreshFolder("priority");
  const auto flat = [&](const std::string& name, double value, double pixel) {
    Write(folder + "/" + name + ".tif", {.width = static_cast<int>(std::lround(2 / pixel)),
                                         .height = static_cast<int>(std::lround(2 / pixel)),
                                         .affine = Degrees(10, 12, pixel),
                                         .value = [=](int, int, int) { return value; }});
    return "path = \"" + name + ".tif\"\ndatum = \"ellipsoid\"";
  };
  const std::vector<std::string> sources{flat("fine", 100, 0.01), flat("as_fine", 200, 0.01), flat("coarse", 300, 0.1)};
  const auto height = [&](const std::string& priority) {
    std::string text = Layer("elevation", sources);
    text.insert(text.find("kind"), priority);
    MustBuild(folder, text);
    return HeightAt(*MustOpen(folder), 11, 11);
  };
  EXPECT_NEAR(height(""), 300, 0.1);
  EXPECT_NEAR(height("priority = \"order\"\n"), 300, 0.1);
  EXPECT_NEAR(height("priority = \"resolution\"\n"), 200, 0.1);
  EXPECT_EQ(MustOpen(folder)->layers()[0].sources.back().path, "as_fine.tif") << "the record says which is best";
}

}  // namespace
}  // namespace belvedere

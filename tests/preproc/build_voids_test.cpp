// Builds of elevation whose sources have voids: what fills them, and that nothing else changes.
#include "preproc/build.h"

#include "preproc/report.h"
#include "tests/preproc/built_pages.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace belvedere {
namespace {

using namespace testing_rasters;

constexpr double kNodata = -9999;

double Hills(double longitude, double latitude) {
  return 200 * std::sin(6 * longitude) * std::cos(7 * latitude);
}

struct Hole {
  double longitude = 0, latitude = 0, radius = 0;  // degrees
  bool Holds(double east, double north) const { return std::hypot(east - longitude, north - latitude) < radius; }
};

// Hills, lifted by an offset, with holes, of 2 x 2 degrees from 1 E 1 N on unless said otherwise.
struct Ground {
  double offset_m = 0;
  std::vector<Hole> holes{};
  double west = 1, south = 1, side = 2, pixel = 0.01;
};

std::string WriteGround(const std::string& path, const Ground& ground) {
  const int pixels = static_cast<int>(std::lround(ground.side / ground.pixel));
  return Write(path, {.width = pixels,
                      .height = pixels,
                      .affine = Degrees(ground.west, ground.south + ground.side, ground.pixel),
                      .value =
                          [&](int, int column, int row) {
                            const double longitude = ground.west + ground.pixel * (column + 0.5);
                            const double latitude = ground.south + ground.side - ground.pixel * (row + 0.5);
                            for (const Hole& hole : ground.holes) {
                              if (hole.Holds(longitude, latitude)) return kNodata;
                            }
                            return ground.offset_m + Hills(longitude, latitude);
                          },
                      .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(kNodata); }});
}

std::string Ellipsoid(const std::string& name) {
  return "path = \"" + name + "\"\ndatum = \"ellipsoid\"";
}

// The greatest difference between posts 1 km apart along both lines through a position, at a level.
double SteepestStep(const Dataset& dataset, double latitude, double longitude, double half_width, int level) {
  double most = 0;
  for (const bool eastwards : {false, true}) {
    double before = 0;
    for (int i = 0; i <= 200; ++i) {
      const double at = half_width * (i - 100) / 100;
      const double height = HeightAt(dataset, latitude + (eastwards ? 0 : at), longitude + (eastwards ? at : 0), level);
      if (i > 0) most = std::max(most, std::abs(height - before));
      before = height;
    }
  }
  return most;
}

TEST(BuildVoids, AVoidIsFilledFromBelowShiftedAsItsRimAsks) {
  const std::string folder = FreshFolder("void");
  WriteGround(folder + "/below.tif", {.west = 0, .south = 0, .side = 4, .pixel = 0.02});
  WriteGround(folder + "/inset.tif", {.offset_m = 150, .holes = {{2, 2, 0.25}, {1.5, 2.5, 0.006}}});
  MustBuild(folder, Layer("elevation", {Ellipsoid("below.tif"), Ellipsoid("inset.tif")}));
  const auto dataset = MustOpen(folder);
  const int finest = dataset->FinestContaining(0, 2, 2).level();
  for (int level = finest - 4; level <= finest; ++level) {
    // The hills are 1200 m a degree at their steepest.
    EXPECT_LT(SteepestStep(*dataset, 2.01, 2.01, 0.5, level), 1400 * 0.005 + 3) << "level " << level;
  }
  for (double from = -0.3; from < 0.3; from += 0.02) {
    EXPECT_NEAR(HeightAt(*dataset, 2, 2 + from), 150 + Hills(2 + from, 2), 6) << from;
    EXPECT_NEAR(HeightAt(*dataset, 2 + from, 2), 150 + Hills(2, 2 + from), 6) << from;
  }
  EXPECT_NEAR(HeightAt(*dataset, 2.5, 1.5), 150 + Hills(1.5, 2.5), 6) << "one pixel";
  ExpectSharedPosts(*dataset);
  EXPECT_TRUE(VerifyDataset(*dataset).problems.empty());
}

TEST(BuildVoids, WhatIsValidStaysAsItIs) {
  const std::string with = FreshFolder("with_void"), without = FreshFolder("without_void");
  for (const std::string& folder : {with, without}) {
    WriteGround(folder + "/below.tif", {.west = 0, .south = 0, .side = 4, .pixel = 0.02});
    WriteGround(folder + "/inset.tif",
                {.offset_m = 150, .holes = folder == with ? std::vector<Hole>{{2, 2, 0.25}} : std::vector<Hole>{}});
    MustBuild(folder, Layer("elevation", {Ellipsoid("below.tif"), Ellipsoid("inset.tif")}));
  }
  const auto a = MustOpen(with), b = MustOpen(without);
  int same = 0;
  for (const uint64_t word : a->Nodes(0)) {
    const Quadcode node = *Quadcode::FromWord(word);
    if (node.level() < 4 || !b->Exists(0, node)) continue;
    const auto own = a->ReadElevation(0, node), other = b->ReadElevation(0, node);
    ASSERT_TRUE(own.ok() && other.ok());
    const double spacing = node.HeightDegrees() / kCells;
    for (int row = 0; row < kPosts; ++row) {
      for (int column = 0; column < kPosts; ++column) {
        const double longitude = node.Box().west_deg + spacing * column,
                     latitude = node.Box().south_deg + spacing * row;
        if (std::hypot(longitude - 2, latitude - 2) < 0.27 + 2 * spacing) continue;
        ASSERT_EQ((*own)->at(column, row), (*other)->at(column, row)) << node.ToString();
        ++same;
      }
    }
  }
  EXPECT_GT(same, 10'000);
}

TEST(BuildVoids, AVoidThatIsTooWideFadesToWhatLiesBelow) {
  const std::string folder = FreshFolder("wide_void");
  WriteGround(folder + "/below.tif", {.west = 0, .south = 0, .side = 4, .pixel = 0.02});
  WriteGround(folder + "/inset.tif", {.offset_m = 150, .holes = {{2, 2, 0.9}}});
  MustBuild(folder, Layer("elevation", {Ellipsoid("below.tif"), Ellipsoid("inset.tif")}));
  const auto dataset = MustOpen(folder);
  EXPECT_NEAR(HeightAt(*dataset, 2, 2), Hills(2, 2), 4) << "90 pixels from the rim";
  EXPECT_NEAR(HeightAt(*dataset, 2, 1.3), 150 + Hills(1.3, 2), 6) << "20 pixels from the rim";
  EXPECT_LT(SteepestStep(*dataset, 2.01, 2.01, 0.95, kMaxLevel), 1400 * 0.0095 + 6);
}

TEST(BuildVoids, InEachOfNestedSources) {
  const std::string folder = FreshFolder("nested_voids");
  WriteGround(folder + "/world.tif", {.west = 0, .south = 0, .side = 4, .pixel = 0.04});
  WriteGround(folder + "/middle.tif", {.offset_m = 100, .holes = {{2, 2, 0.2}}});
  WriteGround(folder + "/inner.tif",
              {.offset_m = 160, .holes = {{2, 2, 0.05}}, .west = 1.7, .south = 1.7, .side = 0.6, .pixel = 0.002});
  MustBuild(folder, Layer("elevation", {Ellipsoid("world.tif"), Ellipsoid("middle.tif"), Ellipsoid("inner.tif")}));
  const auto dataset = MustOpen(folder);
  EXPECT_GT(dataset->FinestContaining(0, 2, 2).level(), dataset->FinestContaining(0, 2, 1.4).level());
  EXPECT_NEAR(HeightAt(*dataset, 2, 2), 160 + Hills(2, 2), 6);
  EXPECT_NEAR(HeightAt(*dataset, 2, 2.04), 160 + Hills(2.04, 2), 6);
  EXPECT_LT(SteepestStep(*dataset, 2.001, 2.001, 0.2, kMaxLevel), 1400 * 0.002 + 2);
  ExpectSharedPosts(*dataset);
}

TEST(BuildVoids, InTheLowestSourceAndUnderAFeather) {
  const std::string folder = FreshFolder("lowest_void");
  WriteGround(folder + "/only.tif", {.offset_m = 800, .holes = {{2, 2, 0.1}, {1.3, 2, 0.05}}});
  MustBuild(folder, Layer("elevation", {Ellipsoid("only.tif") + "\nfeather_m = 50000"}));
  const auto dataset = MustOpen(folder);
  // Over so short a way the hills are all that the fill lacks.
  EXPECT_NEAR(HeightAt(*dataset, 2, 2), 800 + Hills(2, 2), 60);
  EXPECT_LT(SteepestStep(*dataset, 2.001, 2.001, 0.2, kMaxLevel), 1400 * 0.002 * 2);
  EXPECT_LT(SteepestStep(*dataset, 2.001, 1.301, 0.1, kMaxLevel), (1400 + 1.5 * 800 / 0.45) * 0.001 * 2)
      << "where the feather is too";
  EXPECT_GT(HeightAt(*dataset, 2, 1.3), 400);
}

// A void over 180 E of a source that goes round the Earth, and noise, so that nothing agrees by chance.
TEST(BuildVoids, FilledPostsAreTheSameBitsInEveryPage) {
  const std::string folder = FreshFolder("void_bits");
  std::mt19937 random(6);
  Write(folder + "/world.tif", {.width = 1440,
                                .height = 720,
                                .affine = Degrees(-180, 90, 0.25),
                                .value =
                                    [&](int, int column, int row) {
                                      const double height = static_cast<double>(random() % 3000);
                                      const bool seam = (column < 40 || column >= 1400) && row > 200 && row < 280;
                                      const bool north = row > 20 && row < 28 && column % 14 < 8;
                                      const bool trees = column > 880 && column < 920 && row > 160 && row < 200;
                                      return seam || north || trees ? kNodata : height;
                                    },
                                .finish = [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(kNodata); }});
  MustBuild(folder, Layer("elevation", {Ellipsoid("world.tif")}));
  const auto dataset = MustOpen(folder);
  EXPECT_GT(dataset->MaxLevel(0), 0);
  ExpectSharedPosts(*dataset);
  EXPECT_GT(HeightAt(*dataset, 30, -179.9), 600) << "filled over the seam";
}

}  // namespace
}  // namespace belvedere

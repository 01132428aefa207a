// Builds of imagery whose sources are matched to what lies below them.
#include "preproc/build.h"

#include "preproc/report.h"
#include "preproc/report_page.h"
#include "tests/preproc/built_pages.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

using namespace testing_rasters;

// What the ground looks like, band from 1.
double Ground(int band, double longitude, double latitude) {
  return 115 + 50 * std::sin(3 * longitude + band) * std::cos(3 * latitude - band) + 10 * band;
}

struct Scene {
  double west = 0, north = 0, side = 0, pixel = 0.01;
  double gain = 1, offset = 0;  // of the ground's colours
  bool clouds = false;          // over a fifth of it
};

void WriteScene(const std::string& path, const Scene& scene) {
  const int pixels = static_cast<int>(std::lround(scene.side / scene.pixel));
  Write(path, {.width = pixels,
               .height = pixels,
               .bands = 3,
               .type = GDT_Byte,
               .affine = Degrees(scene.west, scene.north, scene.pixel),
               .value = [&](int band, int column, int row) {
                 if (scene.clouds && row < pixels / 5) return 250.0;
                 const double colour =
                     Ground(band, scene.west + scene.pixel * (column + 0.5), scene.north - scene.pixel * (row + 0.5));
                 return std::clamp(std::round(scene.gain * colour + scene.offset), 0.0, 255.0);
               }});
}

std::string Matched(const std::string& name) {
  return "path = \"" + name + "\"\nmatch_colour = true";
}

void ExpectGround(const Dataset& dataset, double latitude, double longitude, int tolerance) {
  const auto texel = TexelAt(dataset, latitude, longitude);
  for (int band = 1; band <= 3; ++band) {
    EXPECT_NEAR(texel[static_cast<size_t>(band - 1)], Ground(band, longitude, latitude), tolerance)
        << latitude << " " << longitude << " band " << band;
  }
}

TEST(BuildColour, ASourceTakesTheColoursOfWhatLiesBelow) {
  const std::string folder = FreshFolder("match");
  WriteScene(folder + "/below.tif", {.west = 0, .north = 50, .side = 6, .pixel = 0.05});
  WriteScene(folder + "/scene.tif", {.west = 1, .north = 49, .side = 3, .gain = 0.6, .offset = 70, .clouds = true});
  WriteScene(folder + "/inner.tif", {.west = 2, .north = 48, .side = 0.8, .pixel = 0.005, .gain = 1.3, .offset = -60});
  const auto plain = MustBuild(folder, Layer("imagery", {"path = \"below.tif\"", "path = \"scene.tif\""}));
  EXPECT_GT(std::abs(TexelAt(*MustOpen(folder), 47, 1.5)[0] - Ground(1, 1.5, 47)), 15) << "as it is";

  const auto report =
      MustBuild(folder, Layer("imagery", {"path = \"below.tif\"", Matched("scene.tif"), Matched("inner.tif")}));
  EXPECT_TRUE(report.warnings.empty());
  const auto dataset = MustOpen(folder);
  for (double at = 0.1; at < 2.2; at += 0.17) ExpectGround(*dataset, 46.1 + at, 1.1 + at, 4);
  for (double at = 0.05; at < 0.7; at += 0.11) ExpectGround(*dataset, 47.25 + at, 2.05 + at, 5);
  EXPECT_GT(TexelAt(*dataset, 48.8, 2)[0], 230) << "clouds are still clouds";

  const std::vector<SourceRecord>& sources = dataset->layers()[0].sources;
  EXPECT_FALSE(sources[0].colour_fit);
  ASSERT_TRUE(sources[1].colour_fit && sources[2].colour_fit);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(sources[1].colour_fit->gain[c], 1 / 0.6, 0.06);
    EXPECT_NEAR(sources[1].colour_fit->offset[c], -70 / 0.6, 9);
    EXPECT_NEAR(sources[2].colour_fit->gain[c], 1 / 1.3, 0.04) << "to the matched source below, not as that is itself";
    EXPECT_NEAR(sources[2].colour_fit->offset[c], 60 / 1.3, 6);
  }
  const std::string fit = FitText(*sources[1].colour_fit);
  EXPECT_NE(DescribeDataset(*dataset).find("colours " + fit), std::string::npos);
  EXPECT_NE(DescribeDatasetJson(*dataset).find("\"colour_fit\""), std::string::npos);
  const auto page = ReportPage(*dataset, report);
  ASSERT_TRUE(page.ok()) << page.message();
  EXPECT_NE(page->find(fit), std::string::npos);
}

TEST(BuildColour, WithTooLittleBelowASourceStaysAsItIsAndThatIsSaid) {
  const std::string folder = FreshFolder("unmatched");
  WriteScene(folder + "/below.tif", {.west = 0, .north = 50, .side = 6, .pixel = 0.05});
  // A scene that is off what lies below but for a corner, and one of 3 x 3 of its pixels.
  WriteScene(folder + "/corner.tif", {.west = 5.8, .north = 44.2, .side = 3, .gain = 0.5});
  WriteScene(folder + "/small.tif", {.west = 3, .north = 48, .side = 0.15, .gain = 0.5});
  const auto report =
      MustBuild(folder, Layer("imagery", {Matched("below.tif"), Matched("corner.tif"), Matched("small.tif")}));
  ASSERT_EQ(report.warnings.size(), 3u);
  for (const SourceRemark& warning : report.warnings) {
    EXPECT_NE(warning.reason.find("left as they are"), std::string::npos) << warning.reason;
    EXPECT_NE(warning.reason.find("match_colour"), std::string::npos) << warning.reason;
  }
  EXPECT_EQ(report.warnings[1].source, "corner.tif");
  const auto dataset = MustOpen(folder);
  for (const SourceRecord& source : dataset->layers()[0].sources) EXPECT_FALSE(source.colour_fit);
  EXPECT_NEAR(TexelAt(*dataset, 42.5, 7.5)[0], 0.5 * Ground(1, 7.5, 42.5), 3);
}

TEST(BuildColour, OnOneWorkerAndOnManyTheFitIsTheSame) {
  std::vector<ColourFit> fits;
  for (const int jobs : {1, 4}) {
    const std::string folder = FreshFolder("match_jobs");
    WriteScene(folder + "/below.tif", {.west = 0, .north = 50, .side = 6, .pixel = 0.05});
    WriteScene(folder + "/scene.tif", {.west = 1, .north = 49, .side = 3, .gain = 0.6, .offset = 70});
    MustBuild(folder, Layer("imagery", {"path = \"below.tif\"", Matched("scene.tif")}), jobs);
    const auto dataset = MustOpen(folder);
    ASSERT_TRUE(dataset->layers()[0].sources[1].colour_fit);
    fits.push_back(*dataset->layers()[0].sources[1].colour_fit);
  }
  EXPECT_EQ(fits[0].gain, fits[1].gain);
  EXPECT_EQ(fits[0].offset, fits[1].offset);
}

}  // namespace
}  // namespace belvedere

// Rasters that break careless readers, from the shared fixtures: each is used as it should be, or skipped with a
// reason.

#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

namespace belvedere {
namespace {

using namespace testing_rasters;

std::optional<std::string> Fixtures() {
  const std::string path = std::string(BELVEDERE_SOURCE_DIR) + "/../shared/data";
  if (std::filesystem::exists(path + "/awkward")) return std::filesystem::canonical(path).string();
  return std::nullopt;
}

// Builds one source alone; the reason when it was skipped, else an empty string.
std::string SkippedBecause(const std::string& kind, const std::string& source, const std::string& more = "") {
  const std::string folder = FreshFolder("awkward");
  const auto spec = ParseSpec(Layer(kind, {"path = \"" + source + "\"\n" + more}), folder + "/spec.toml");
  EXPECT_TRUE(spec.ok()) << spec.message();
  BuildOptions options;
  options.out = folder + "/out";
  options.jobs = 2;
  options.show_progress = false;
  const auto report = Build(*spec, options, Clock::System());
  if (!report.ok()) return report.message();
  EXPECT_TRUE(report->skipped.empty());
  return "";
}

TEST(Awkward, UsableImagesAreUsed) {
  const auto shared = Fixtures();
  if (!shared) GTEST_SKIP() << "the shared fixtures are not beside the project";
  for (const char* name : {"qgis/band1_byte_ct_epsg4326.tif", "qgis/raster_layer.tiff", "rasterio/RGB2.byte.tif",
                           "rasterio/RGBA.byte.tif", "rasterio/cogeo.tif"}) {
    EXPECT_EQ(SkippedBecause("imagery", *shared + "/awkward/" + name), "") << name;
  }
}

TEST(Awkward, UsableHeightsAreUsed) {
  const auto shared = Fixtures();
  if (!shared) GTEST_SKIP() << "the shared fixtures are not beside the project";
  for (const char* name :
       {"qgis/band1_float32_noct_epsg4326.tif", "qgis/dem.tif", "qgis/unique_1.tif", "rasterio/byte.tif"}) {
    EXPECT_EQ(SkippedBecause("elevation", *shared + "/awkward/" + name), "") << name;
  }
}

TEST(Awkward, TheUnusableSayWhy) {
  const auto shared = Fixtures();
  if (!shared) GTEST_SKIP() << "the shared fixtures are not beside the project";
  const struct {
    const char *kind, *name, *reason;
  } kBad[] = {{"imagery", "rasterio/corrupt.tif", "truncated or damaged"},
              {"imagery", "qgis/rgb_with_mask.tif", "no georeference"},
              {"elevation", "qgis/scaleoffset.tif", "no coordinate reference system"},
              {"elevation", "rasterio/float_nan.tif", "no coordinate reference system"},
              {"elevation", "rasterio/rotated.tif", "no coordinate reference system"}};
  for (const auto& bad : kBad) {
    const std::string reason = SkippedBecause(bad.kind, *shared + "/awkward/" + bad.name);
    EXPECT_NE(reason.find(bad.reason), std::string::npos) << bad.name << ": " << reason;
    EXPECT_NE(reason.find(bad.name), std::string::npos) << reason;
  }
}

TEST(Awkward, AGeoreferenceInTheSpecMakesThemUsable) {
  const auto shared = Fixtures();
  if (!shared) GTEST_SKIP() << "the shared fixtures are not beside the project";
  const std::string folder = *shared + "/awkward/";
  EXPECT_EQ(SkippedBecause("imagery", folder + "qgis/rgb_with_mask.tif", "georeference = [5, 45, 6, 46]"), "");
  EXPECT_EQ(SkippedBecause("elevation", folder + "qgis/scaleoffset.tif",
                           "crs = \"EPSG:25832\"\ngeoreference = [500000, 10, 0, 5000000, 0, -10]"),
            "");
}

TEST(Awkward, PlacesByControlPointsAndByRpcAgree) {
  const auto shared = Fixtures();
  if (!shared) GTEST_SKIP() << "the shared fixtures are not beside the project";
  std::vector<GeoBox> extents;
  for (const char* name : {"gcp", "rpc"}) {
    const std::string folder = FreshFolder(name);
    const auto report =
        MustBuild(folder, Layer("imagery", {"path = \"" + *shared + "/awkward/rasterio/RGB.byte." + name + ".vrt\""}));
    ASSERT_EQ(report.layers.size(), 1u);
    extents.push_back(report.layers[0].sources.at(0).extent);
  }
  EXPECT_NEAR(extents[0].west_deg, extents[1].west_deg, 0.01);
  EXPECT_NEAR(extents[0].north_deg, extents[1].north_deg, 0.01);
}

TEST(Awkward, ProjectedTerrainLandsWhereGdalPutsIt) {
  const auto shared = Fixtures();
  if (!shared) GTEST_SKIP() << "the shared fixtures are not beside the project";
  const std::string folder = FreshFolder("projected");
  MustBuild(folder, Layer("elevation",
                          {"path = \"" + *shared + "/nest_atlantic/bilbao_5m/DEM.tif\"\ndatum = \"ellipsoid\"",
                           "path = \"" + *shared + "/nest_atlantic/somerset_2m/dtm.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  // What gdallocationinfo -wgs84 prints for the pixel there; interpolated, 2 m more or less.
  const struct {
    double latitude, longitude, height_m;
  } kInside[] = {{43.3123, -2.9865, 0}, {43.305, -3.0, 8}, {51.0631, -3.1159, 77}, {51.06, -3.11, 75}};
  for (const auto& at : kInside) {
    const Quadcode node = dataset->FinestContaining(0, at.latitude, at.longitude);
    const auto page = dataset->ReadElevation(0, node);
    ASSERT_TRUE(page.ok());
    EXPECT_GE(node.level(), 13);
    EXPECT_NEAR(BilinearHeight(**page, node, at.latitude, at.longitude), at.height_m, 2);
  }
}

}  // namespace
}  // namespace belvedere

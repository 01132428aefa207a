#include "preproc/source_settings.h"

#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

namespace belvedere {
namespace {

using testing_rasters::FreshFolder;

TEST(SourceSettings, AllOfASourceIsKept) {
  SourceSpec source;
  source.path = "/nowhere/a b.tif";
  source.written_path = "a b.tif";
  source.nodata = -32768.25;
  source.crs = "EPSG:27700";
  source.geotransform = std::array<double, 6>{1, 2, 3, 4, 5, 1.0 / 3};
  source.metres_per_unit = 1200.0 / 3937.0;
  source.datum = VerticalDatum::kOffset;
  source.datum_m = -12.5;
  source.datum_grid = "EPSG:3855";
  source.extent = GeoBox{1, 2, 3, 4};
  source.tiles = "EPSG:32632, 900 x 900, Int16";
  source.feather_m = 0.1;
  source.utc_s = 1072915200;
  source.match_colour = true;
  const auto read = SettingsFromJson(SettingsToJson(source));
  ASSERT_TRUE(read.ok()) << read.message();
  EXPECT_EQ(read->path, source.path);
  EXPECT_EQ(read->written_path, source.written_path);
  EXPECT_EQ(read->nodata, source.nodata);
  EXPECT_EQ(read->crs, source.crs);
  EXPECT_EQ(read->geotransform, source.geotransform);
  EXPECT_FALSE(read->box);
  EXPECT_EQ(read->metres_per_unit, source.metres_per_unit);
  EXPECT_EQ(read->datum, source.datum);
  EXPECT_EQ(read->datum_m, source.datum_m);
  EXPECT_EQ(read->datum_grid, source.datum_grid);
  ASSERT_TRUE(read->extent);
  EXPECT_EQ(read->extent->north_deg, 4);
  EXPECT_EQ(read->tiles, source.tiles);
  EXPECT_EQ(read->feather_m, source.feather_m);
  EXPECT_EQ(read->utc_s, source.utc_s);
  EXPECT_TRUE(read->match_colour);
  source.geotransform.reset();
  source.box = GeoBox{-1, 2, 3, 4.5};
  const auto boxed = SettingsFromJson(SettingsToJson(source));
  ASSERT_TRUE(boxed.ok() && boxed->box);
  EXPECT_EQ(boxed->box->north_deg, 4.5);
  EXPECT_FALSE(SettingsFromJson("{}").ok());
  EXPECT_FALSE(SettingsFromJson("[").ok());
}

TEST(SourceSettings, AFileIsOpenedFromWhereverTheProgramRuns) {
  const std::string folder = FreshFolder("settings");
  std::ofstream(folder + "/a.tif") << "x";
  SourceSpec source;
  source.path = std::filesystem::relative(folder + "/a.tif").string();
  const auto read = SettingsFromJson(SettingsToJson(source));
  ASSERT_TRUE(read.ok());
  EXPECT_TRUE(std::filesystem::path(read->path).is_absolute()) << read->path;
  EXPECT_TRUE(std::filesystem::exists(read->path));
  source.path = std::filesystem::relative(folder).string() + "/*.tif";
  const auto pattern = SettingsFromJson(SettingsToJson(source));
  ASSERT_TRUE(pattern.ok());
  EXPECT_TRUE(std::filesystem::path(pattern->path).is_absolute()) << pattern->path;
}

TEST(SourceSettings, AStateTellsEveryWriteApart) {
  const std::string path = FreshFolder("state") + "/a.tif";
  std::ofstream(path) << "x";
  const std::string before = StateOfFiles({path});
  EXPECT_EQ(StateOfFiles({path}), before);
  std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) + std::chrono::microseconds(1));
  const std::string touched = StateOfFiles({path});
  EXPECT_NE(touched, before);
  const auto time = std::filesystem::last_write_time(path);
  std::ofstream(path) << "xy";
  std::filesystem::last_write_time(path, time);
  EXPECT_NE(StateOfFiles({path}), touched);
  std::filesystem::remove(path);
  EXPECT_NE(StateOfFiles({path}), touched);
}

}  // namespace
}  // namespace belvedere

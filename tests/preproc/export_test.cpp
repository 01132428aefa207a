// Round trips: made rasters to a dataset, the dataset to files, and the files read again with GDAL.
#include "preproc/export.h"

#include "preproc/layer_raster.h"
#include "preproc/raster_reader.h"
#include "runtime/paging/dataset_writer.h"
#include "runtime/paging/page_codec.h"
#include "tests/preproc/made_raster.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <type_traits>

namespace belvedere {
namespace {

using namespace testing_rasters;
namespace fs = std::filesystem;

ExportReport MustExport(const Dataset& dataset, ExportOptions options) {
  options.show_progress = false;
  const auto report = Export(dataset, options, Clock::System());
  EXPECT_TRUE(report.ok()) << report.message();
  EXPECT_FALSE(fs::exists(options.out + ".partial"));
  return report.ok() ? *report : ExportReport{};
}

std::string Refusal(const Dataset& dataset, ExportOptions options) {
  options.show_progress = false;
  const auto report = Export(dataset, options, Clock::System());
  EXPECT_FALSE(report.ok());
  EXPECT_FALSE(fs::exists(options.out)) << "a file that is not whole";
  EXPECT_FALSE(fs::exists(options.out + ".partial"));
  return report.message();
}

// A raster of any kind, whole, as GDAL reads it.
struct ReadBack {
  DatasetHandle handle;
  int width = 0, height = 0, bands = 0;
  std::array<double, 6> affine{};
  std::vector<double> values;  // band by band, row by row from the north

  double at(int band, int column, int row) const {
    return values[(static_cast<size_t>(band) * static_cast<size_t>(height) + static_cast<size_t>(row)) *
                      static_cast<size_t>(width) +
                  static_cast<size_t>(column)];
  }
  double longitude(int column) const { return affine[0] + (column + 0.5) * affine[1]; }
  double latitude(int row) const { return affine[3] + (row + 0.5) * affine[5]; }
};

ReadBack Read(const std::string& path) {
  ReadBack read;
  read.handle.reset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  EXPECT_NE(read.handle, nullptr) << path;
  if (!read.handle) return read;
  GDALDataset& dataset = *read.handle;
  read.width = dataset.GetRasterXSize();
  read.height = dataset.GetRasterYSize();
  read.bands = dataset.GetRasterCount();
  EXPECT_EQ(dataset.GetGeoTransform(read.affine.data()), CE_None);
  read.values.resize(static_cast<size_t>(read.bands) * static_cast<size_t>(read.width) *
                     static_cast<size_t>(read.height));
  EXPECT_EQ(dataset.RasterIO(GF_Read, 0, 0, read.width, read.height, read.values.data(), read.width, read.height,
                             GDT_Float64, read.bands, nullptr, 0, 0, 0, nullptr),
            CE_None);
  return read;
}

// The pages of layer 0 of a dataset, each read once.
template <typename PageType>
class StoredPages {
 public:
  explicit StoredPages(const Dataset& dataset) : dataset_(dataset) {}

  const Dataset& dataset() const { return dataset_; }
  const PageType& At(Quadcode node) {
    auto& page = pages_[node.word()];
    if (page) return *page;
    if constexpr (std::is_same_v<PageType, ElevationPage>) {
      page = *dataset_.ReadElevation(0, node);
    } else {
      page = *dataset_.ReadImage(0, node);
    }
    return *page;
  }

 private:
  const Dataset& dataset_;
  std::map<uint64_t, std::shared_ptr<PageType>> pages_;
};

// The post of a level at a position that is one, where a page of that level has it.
std::optional<int32_t> StoredPost_mm(StoredPages<ElevationPage>& pages, int level, double longitude, double latitude) {
  const double spacing = 45.0 / kCells / (1 << level);
  const int64_t column = std::llround((longitude + 180) / spacing), row = std::llround((latitude + 90) / spacing);
  EXPECT_NEAR(static_cast<double>(column) * spacing - 180, longitude, 1e-9) << "pixels lie on posts";
  EXPECT_NEAR(static_cast<double>(row) * spacing - 90, latitude, 1e-9);
  for (const auto& [dx, dy] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
    const int64_t node_column = (column - dx) >> kCellsLog2, node_row = (row - dy) >> kCellsLog2;
    if (node_row < 0 || node_row >= int64_t{kTreeRows} << level) continue;
    const Quadcode node = Quadcode::FromColumnRow(level, node_column, node_row);
    if (!pages.dataset().Exists(0, node)) continue;
    return pages.At(node).at(static_cast<int>(column - node_column * kCells),
                             static_cast<int>(row - node_row * kCells));
  }
  return std::nullopt;
}

// Rough ground over the whole Earth, and fine ground over 180 E and the equator, where four trees meet.
std::string HeightsFolder() {
  const std::string folder = FreshFolder("export_heights");
  std::mt19937 random(11);
  Write(folder + "/world.tif",
        {.width = 256, .height = 128, .affine = Degrees(-180, 90, 360.0 / 256), .value = [&](int, int, int) {
           return static_cast<double>(random() % 3000);
         }});
  Write(folder + "/seam.tif",
        {.width = 75, .height = 75, .affine = Degrees(178.5, 1.5, 0.04), .value = [&](int, int, int) {
           return static_cast<double>(random() % 9000);
         }});
  MustBuild(folder, Layer("elevation", {"path = \"world.tif\"", "path = \"seam.tif\""}));
  return folder;
}

TEST(Export, HeightsAreThoseStoredAtEveryPostOver180EAndPageBorders) {
  const std::string folder = HeightsFolder();
  const auto dataset = MustOpen(folder);
  StoredPages<ElevationPage> pages(*dataset);
  const std::string out = folder + "/seam_out.tif";
  const auto report = MustExport(*dataset, {.layer = "elevation", .out = out, .extent = GeoBox{173, -7, -173, 7}});
  EXPECT_EQ(report.grid.level, dataset->MaxLevel(0));
  const ReadBack read = Read(out);
  EXPECT_NEAR(read.longitude(0), 173, 0.05);
  EXPECT_NEAR(read.longitude(read.width - 1), 187, 0.05);
  int exact = 0, east_of_180 = 0, enlarged = 0;
  for (int row = 0; row < read.height; ++row) {
    for (int column = 0; column < read.width; ++column) {
      const double longitude = read.longitude(column), latitude = read.latitude(row);
      const auto stored_mm = StoredPost_mm(pages, report.grid.level, longitude, latitude);
      const double height_m = read.at(0, column, row);
      if (stored_mm) {
        ASSERT_EQ(height_m, static_cast<double>(static_cast<float>(*stored_mm / 1000.0))) << column << " " << row;
        ASSERT_EQ(std::llround(height_m * 1000), *stored_mm) << "the millimetre comes back";
        ++exact;
        if (longitude > 180) ++east_of_180;
        continue;
      }
      const Quadcode node = dataset->FinestContaining(0, latitude, longitude > 180 ? longitude - 360 : longitude);
      ASSERT_NEAR(height_m, BilinearHeight(pages.At(node), node, latitude, longitude), 1e-3) << column << " " << row;
      ++enlarged;
    }
  }
  EXPECT_GT(exact, 20'000);
  EXPECT_GT(east_of_180, 5'000);
  EXPECT_GT(enlarged, 100);
}

TEST(Export, APostOnABorderIsTheFinerPagesWhereverAWindowBegins) {
  const std::string folder = HeightsFolder();
  const auto dataset = MustOpen(folder);
  StoredPages<ElevationPage> pages(*dataset);
  const auto fine = PlanExport(*dataset, 0, std::nullopt, std::nullopt);
  ASSERT_TRUE(fine.ok());
  LayerPixels pixels(*dataset, 0, fine->level, Enlarge::kCoarser);
  const double spacing = fine->SpacingDegrees();
  const int64_t east = fine->first_column + fine->width - 1, north = fine->first_row + fine->height - 1;
  int fine_posts = 0;
  for (const auto& [column, row] : {std::pair{east, fine->first_row}, std::pair{fine->first_column, north}}) {
    std::vector<float> heights_m(200 * 200);
    ASSERT_TRUE(pixels.ReadHeights({column, row, 200, 200}, heights_m).ok());
    for (int i = 0; i < 200 * 200; ++i) {
      const auto stored_mm = StoredPost_mm(pages, fine->level, static_cast<double>(column + i % 200) * spacing - 180,
                                           static_cast<double>(row + i / 200) * spacing - 90);
      if (!stored_mm) continue;
      ASSERT_EQ(std::llround(1000.0 * static_cast<double>(heights_m[static_cast<size_t>(i)])), *stored_mm) << i;
      ++fine_posts;
    }
  }
  EXPECT_GE(fine_posts, 400);
}

TEST(Export, AHeightAtAKnownPlaceIsTheSources) {
  const std::string folder = FreshFolder("export_ramp");
  Write(folder + "/ramp.tif",
        {.width = 300, .height = 300, .affine = Degrees(20, 30, 0.01), .value = [](int, int column, int row) {
           return 1000 + 2.0 * column + 1.0 * row;
         }});
  MustBuild(folder, Layer("elevation", {"path = \"ramp.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  MustExport(*dataset, {.layer = "elevation", .out = folder + "/ramp_out.tif", .extent = GeoBox{21, 28, 22, 29}});
  const ReadBack read = Read(folder + "/ramp_out.tif");
  ASSERT_GT(read.width, 90);
  for (int row = 0; row < read.height; ++row) {
    for (int column = 0; column < read.width; ++column) {
      const double source =
          1000 + 2 * ((read.longitude(column) - 20) / 0.01 - 0.5) + ((30 - read.latitude(row)) / 0.01 - 0.5);
      ASSERT_NEAR(read.at(0, column, row), source, 0.005) << "half a pixel aside would be 1.5 m off";
    }
  }
}

TEST(Export, TheFileSaysWhatItsHeightsAre) {
  const std::string folder = HeightsFolder();
  const auto dataset = MustOpen(folder);
  StoredPages<ElevationPage> pages(*dataset);
  MustExport(*dataset, {.layer = "elevation", .out = folder + "/world_out.tif", .level = 0});
  const ReadBack read = Read(folder + "/world_out.tif");
  EXPECT_EQ(read.width, 8 * kCells) << "no post twice";
  EXPECT_EQ(read.latitude(0), 90);
  EXPECT_EQ(read.latitude(read.height - 1), -90);
  for (int column = 0; column < read.width; ++column) {
    ASSERT_EQ(read.at(0, column, 0), read.at(0, 0, 0)) << "a pole has one height";
    ASSERT_EQ(std::llround(1000 * read.at(0, column, read.height - 1)),
              StoredPost_mm(pages, 0, read.longitude(column), -90));
  }
  GDALDataset& file = *read.handle;
  EXPECT_STREQ(file.GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
  EXPECT_STREQ(file.GetMetadataItem("AREA_OR_POINT"), "Point");
  EXPECT_STREQ(file.GetMetadataItem("BELVEDERE_LEVEL"), "0");
  ASSERT_NE(file.GetSpatialRef(), nullptr);
  EXPECT_STREQ(file.GetSpatialRef()->GetAuthorityCode(nullptr), "4979");
  GDALRasterBand& band = *file.GetRasterBand(1);
  EXPECT_EQ(band.GetRasterDataType(), GDT_Float32);
  EXPECT_STREQ(band.GetUnitType(), "m");
  EXPECT_TRUE(std::isnan(band.GetNoDataValue()));
  EXPECT_GE(band.GetOverviewCount(), 1);
}

TEST(Export, WithoutFillingThereIsNodataWhereTheLevelHasNoPage) {
  const std::string folder = HeightsFolder();
  const auto dataset = MustOpen(folder);
  StoredPages<ElevationPage> pages(*dataset);
  const std::string out = folder + "/holes.tif";
  const auto report = MustExport(
      *dataset, {.layer = "elevation", .out = out, .extent = GeoBox{173, -7, -173, 7}, .enlarge = Enlarge::kNothing});
  const ReadBack read = Read(out);
  int holes = 0, heights = 0;
  for (int row = 0; row < read.height; ++row) {
    for (int column = 0; column < read.width; ++column) {
      const auto stored_mm = StoredPost_mm(pages, report.grid.level, read.longitude(column), read.latitude(row));
      ASSERT_EQ(std::isnan(read.at(0, column, row)), !stored_mm) << column << " " << row;
      ++(stored_mm ? heights : holes);
    }
  }
  EXPECT_GT(holes, 100);
  EXPECT_GT(heights, 100);
}

// Colours that change slowly from west to east and from south to north, seen in the middle of the Earth's far side; a
// part of it is transparent.
std::string ColoursFolder() {
  const std::string folder = FreshFolder("export_colours");
  Write(folder + "/world.tif",
        {.width = 1440,
         .height = 720,
         .bands = 4,
         .type = GDT_Byte,
         .affine = Degrees(-180, 90, 0.25),
         .value =
             [](int band, int column, int row) {
               const double longitude = (column + 0.5) * 0.25 - 180, latitude = 90 - (row + 0.5) * 0.25;
               if (band == 4) return longitude > 60 && longitude < 100 && latitude > 0 && latitude < 40 ? 0.0 : 255.0;
               return band == 1 ? 128 + 120 * std::cos(longitude * M_PI / 180) : band == 2 ? 128 + latitude : 40.0;
             },
         .finish = [](GDALDataset& d) { d.GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand); }});
  MustBuild(folder, Layer("imagery", {"path = \"world.tif\""}));
  return folder;
}

TEST(Export, ColoursAreTheTexelsStoredOver180E) {
  const std::string folder = ColoursFolder();
  const auto dataset = MustOpen(folder);
  StoredPages<ImagePage> pages(*dataset);
  const std::string out = folder + "/far.tif";
  const auto report = MustExport(*dataset, {.layer = "imagery", .out = out, .extent = GeoBox{170, -20, 190, 20}});
  const ReadBack read = Read(out);
  ASSERT_EQ(read.bands, 4);
  EXPECT_EQ(read.handle->GetRasterBand(4)->GetColorInterpretation(), GCI_AlphaBand);
  EXPECT_STREQ(read.handle->GetSpatialRef()->GetAuthorityCode(nullptr), "4326");
  for (int row = 0; row < read.height; ++row) {
    for (int column = 0; column < read.width; ++column) {
      const double longitude = read.longitude(column), latitude = read.latitude(row);
      const Quadcode node =
          Quadcode::Containing(latitude, longitude > 180 ? longitude - 360 : longitude, report.grid.level);
      const GeoBox box = node.Box();
      const double east = longitude - box.west_deg - (longitude > 180 ? 360 : 0);
      const auto x = static_cast<int>(east / node.HeightDegrees() * kImageInner);
      const auto y = static_cast<int>((latitude - box.south_deg) / node.HeightDegrees() * kImageInner);
      for (int band = 0; band < 4; ++band) {
        const auto texel = static_cast<size_t>((y + kImageGutter) * kImageSide + x + kImageGutter);
        ASSERT_EQ(read.at(band, column, row), pages.At(node).texels[4 * texel + static_cast<size_t>(band)]);
      }
      ASSERT_NEAR(read.at(0, column, row), 128 + 120 * std::cos(longitude * M_PI / 180), 1.5);
      ASSERT_NEAR(read.at(1, column, row), 128 + latitude, 1.5);
    }
  }
}

// Near a pole pages are wide: what lies between their posts is enlarged along parallels, without steps or shift.
TEST(Export, AtAPoleHeightsAreThoseOfTheSource) {
  const std::string folder = FreshFolder("export_pole");
  const auto height = [](double longitude, double latitude) {
    return 1000 + 900 * std::cos(latitude * M_PI / 180) * std::cos(longitude * M_PI / 180);
  };
  constexpr double kPixel_deg = 0.25;
  Write(folder + "/cap.tif",
        {.width = 1440, .height = 120, .affine = Degrees(-180, 90, kPixel_deg), .value = [&](int, int column, int row) {
           return height(-180 + (column + 0.5) * kPixel_deg, 90 - (row + 0.5) * kPixel_deg);
         }});
  MustBuild(folder, Layer("elevation", {"path = \"cap.tif\"\nunit = \"m\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  const std::string out = folder + "/cap_out.tif";
  const auto report = MustExport(*dataset, {.layer = "elevation", .out = out, .extent = GeoBox{-30, 65, 60, 90}});
  EXPECT_EQ(report.grid.level, dataset->MaxLevel(0));
  const ReadBack read = Read(out);
  double worst_m = 0;
  for (int row = 0; row < read.height; ++row) {
    if (read.latitude(row) > 90 - kPixel_deg) continue;  // nearer to the pole than the source's own pixels
    for (int column = 0; column < read.width; ++column) {
      const double off_m = read.at(0, column, row) - height(read.longitude(column), read.latitude(row));
      worst_m = std::max(worst_m, std::abs(off_m));
    }
  }
  EXPECT_LT(worst_m, 0.5);
}

TEST(Export, CoarserImageryIsEnlargedWithoutStepsOrShift) {
  const std::string folder = FreshFolder("export_enlarged");
  // Red rises by 25 a degree, ten degrees long.
  Write(folder + "/world.tif",
        {.width = 360,
         .height = 180,
         .bands = 3,
         .type = GDT_Byte,
         .affine = Degrees(-180, 90, 1),
         .value = [](int band, int column, int) { return band == 1 ? column % 10 * 25.0 : 90.0; }});
  Write(folder + "/fine.tif", {.width = 20,
                               .height = 20,
                               .bands = 3,
                               .type = GDT_Byte,
                               .affine = Degrees(5, 9, 0.02),
                               .value = [](int, int, int) { return 250.0; }});
  MustBuild(folder, Layer("imagery", {"path = \"world.tif\"", "path = \"fine.tif\""}));
  const auto dataset = MustOpen(folder);
  ASSERT_GE(dataset->MaxLevel(0), 4);
  const GeoBox extent{4, 7, 14, 9};
  MustExport(*dataset, {.layer = "imagery", .out = folder + "/filled.tif", .extent = extent});
  MustExport(*dataset,
             {.layer = "imagery", .out = folder + "/bare.tif", .extent = extent, .enlarge = Enlarge::kNothing});
  const ReadBack filled = Read(folder + "/filled.tif"), bare = Read(folder + "/bare.tif");
  int enlarged = 0;
  for (int column = 0; column < filled.width; ++column) {
    ASSERT_EQ(filled.at(3, column, 0), 255);
    if (bare.at(3, column, 0) != 0) continue;
    const double in_ten = std::fmod(filled.longitude(column) + 180, 10);
    if (in_ten < 2 || in_ten > 8) continue;
    ASSERT_NEAR(filled.at(0, column, 0), (in_ten - 0.5) * 25, 1.6) << filled.longitude(column);
    ASSERT_EQ(filled.at(1, column, 0), 90);
    ++enlarged;
  }
  EXPECT_GT(enlarged, 50);
}

// Half of a coarse page is red, half is transparent.
TEST(Export, WhatIsTransparentDarkensNothingThatIsEnlarged) {
  const std::string folder = FreshFolder("export_rim");
  auto writer = DatasetWriter::Create(folder + "/out");
  ASSERT_TRUE(writer.ok());
  std::vector<uint8_t> half(4 * kImageTexels, 0);
  for (size_t i = 0; i < kImageTexels; i += 2) half[4 * i] = half[4 * i + 3] = 255;
  for (int tree = 0; tree < kTrees; ++tree)
    ASSERT_TRUE((*writer)->Put(0, Quadcode::Root(tree), EncodeImage(half)).ok());
  for (int which = 0; which < 4; ++which)
    ASSERT_TRUE((*writer)->Put(0, Quadcode::Root(0).Child(which), EncodeImage(half)).ok());
  LayerRecord record;
  record.name = "imagery";
  record.kind = LayerKind::kImagery;
  ASSERT_TRUE((*writer)->Finish({record}, "").ok());
  const auto dataset = MustOpen(folder);
  LayerPixels pixels(*dataset, 0, 1, Enlarge::kCoarser);
  std::vector<uint8_t> row(4 * 100);
  ASSERT_TRUE(pixels.ReadColours({2 * kImageInner + 10, 50, 100, 1}, row).ok());
  for (size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(row[4 * i], 255) << i;
    EXPECT_TRUE(row[4 * i + 3] == 64 || row[4 * i + 3] == 191) << int{row[4 * i + 3]};
  }
}

TEST(Export, TilesShowTheColoursAtTheirPlacesFromZoom0On) {
  const std::string folder = ColoursFolder();
  const auto dataset = MustOpen(folder);
  const std::string out = folder + "/world.mbtiles";
  MustExport(*dataset, {.layer = "imagery", .out = out});
  const ReadBack read = Read(out);
  ASSERT_EQ(read.bands, 4);
  EXPECT_STREQ(read.handle->GetSpatialRef()->GetAuthorityCode(nullptr), "3857");
  EXPECT_STREQ(read.handle->GetMetadataItem("minzoom"), "0");
  EXPECT_STREQ(read.handle->GetMetadataItem("name"), "imagery");
  EXPECT_EQ(read.width, 256 << read.handle->GetRasterBand(1)->GetOverviewCount());
  // 0.18 degrees a texel at level 0 are 20 km, which is zoom 3; the source is of level 0 or 1.
  EXPECT_GE(read.width, 2048);
  const double radius_m = 6378137;
  for (double latitude = -84; latitude <= 84; latitude += 7) {
    for (double longitude = -179.9; longitude < 180; longitude += 8.995) {
      const double x_m = radius_m * longitude * M_PI / 180;
      const double y_m = radius_m * std::log(std::tan(M_PI / 4 + latitude * M_PI / 360));
      const auto column = static_cast<int>((x_m - read.affine[0]) / read.affine[1]);
      const auto row = static_cast<int>((y_m - read.affine[3]) / read.affine[5]);
      const bool rim = longitude > 58 && longitude < 102 && latitude > -2 && latitude < 42;
      const bool clear = longitude > 62 && longitude < 98 && latitude > 2 && latitude < 38;
      if (clear) {
        ASSERT_EQ(read.at(3, column, row), 0) << latitude << " " << longitude;
        continue;
      }
      if (rim) continue;
      ASSERT_EQ(read.at(3, column, row), 255) << latitude << " " << longitude;
      ASSERT_NEAR(read.at(0, column, row), 128 + 120 * std::cos(longitude * M_PI / 180), 3) << longitude;
      ASSERT_NEAR(read.at(1, column, row), 128 + latitude, 3) << latitude;
    }
  }
}

TEST(Export, WhatCannotBeIsRefusedWithTheReason) {
  const std::string folder = FreshFolder("export_refused");
  const auto one = [](int, int, int) { return 1.0; };
  Write(folder + "/one.tif",
        {.width = 36, .height = 18, .type = GDT_Byte, .affine = Degrees(-180, 90, 10), .value = one});
  MustBuild(folder, Layer("elevation", {"path = \"one.tif\""}) + Layer("imagery", {"path = \"one.tif\""}));
  const auto dataset = MustOpen(folder);
  const auto expect = [&](const ExportOptions& options, const std::string& reason) {
    const std::string refusal = Refusal(*dataset, options);
    EXPECT_NE(refusal.find(reason), std::string::npos) << refusal;
  };
  expect({.layer = "roads", .out = folder + "/a.tif"}, "has no layer roads; it has elevation, imagery");
  expect({.layer = "elevation", .out = folder + "/a.mbtiles"}, "pictures of 8 bits");
  expect({.layer = "imagery", .out = folder + "/a.jpg"}, "FILE.tif or FILE.mbtiles");
  expect({.layer = "imagery", .out = folder + "/a.tif", .level = 3}, "no page of level 3");
  expect({.layer = "imagery", .out = folder + "/a.tif", .extent = GeoBox{0, 0, 1, 100}}, "not on the Earth");
  expect({.layer = "imagery", .out = folder + "/none/a.tif"}, "check the folder");
  expect({.layer = "imagery", .out = folder + "/a.mbtiles", .extent = GeoBox{170, 0, 190, 1}}, "over 180 E");
  expect({.layer = "imagery", .out = folder + "/a.mbtiles", .extent = GeoBox{0, 86, 10, 90}}, "tiles end at");
}

TEST(Export, ABadPageIsNamedAndLeavesWhatWasThere) {
  const std::string folder = FreshFolder("export_damaged");
  auto writer = DatasetWriter::Create(folder + "/out");
  ASSERT_TRUE(writer.ok());
  ElevationPage flat;
  flat.heights_mm.assign(static_cast<size_t>(kElevationSide) * kElevationSide, 5000);
  for (int tree = 0; tree < kTrees; ++tree) {
    auto value = EncodeElevation(flat);
    if (tree == 20) value.back() ^= 1;
    ASSERT_TRUE((*writer)->Put(0, Quadcode::Root(tree), value).ok());
  }
  LayerRecord record;
  record.name = "elevation";
  ASSERT_TRUE((*writer)->Finish({record}, "").ok());
  const auto dataset = MustOpen(folder);
  const std::string out = folder + "/a.tif";
  std::ofstream(out) << "what was there";
  const auto report = Export(*dataset, {.layer = "elevation", .out = out, .show_progress = false}, Clock::System());
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.message().find("quadnode 20:"), std::string::npos) << report.message();
  EXPECT_EQ(fs::file_size(out), 14u);
  EXPECT_FALSE(fs::exists(out + ".partial"));
}

// 4 million by 2 million heights: what is read is what is made.
TEST(Export, NoRasterIsMadeAtOnce) {
  const std::string folder = FreshFolder("export_large");
  Write(folder + "/dot.tif",
        {.width = 2, .height = 2, .affine = Degrees(100, 40, 1e-4), .value = [](int, int, int) { return 9.0; }});
  MustBuild(folder, Layer("elevation", {"path = \"dot.tif\"\ndatum = \"ellipsoid\""}));
  const auto dataset = MustOpen(folder);
  ASSERT_GE(dataset->MaxLevel(0), 11);
  const auto grid = PlanExport(*dataset, 0, GeoBox{-180, -90, 180, 90}, std::nullopt);
  ASSERT_TRUE(grid.ok()) << grid.message();
  ASSERT_GE(grid->width, 1 << 21);
  LayerRaster raster(*dataset, 0, *grid, Enlarge::kCoarser);
  std::vector<float> corner(300 * 300);
  const auto affine = grid->GeoTransform();
  const int column = static_cast<int>((100 - affine[0]) / affine[1]) - 150;
  const int row = static_cast<int>((40 - affine[3]) / affine[5]) - 150;
  ASSERT_EQ(raster.GetRasterBand(1)->RasterIO(GF_Read, column, row, 300, 300, corner.data(), 300, 300, GDT_Float32, 0,
                                              0, nullptr),
            CE_None);
  EXPECT_EQ(std::count(corner.begin(), corner.end(), 9.0f) > 0, true);
  EXPECT_LT(raster.pages_read(), 40);
}

}  // namespace
}  // namespace belvedere

// Rasters that a test makes for itself, and builds of them.
#pragma once

#include "preproc/build.h"
#include "preproc/spec.h"
#include "runtime/paging/dataset.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace belvedere::testing_rasters {

inline std::string FreshFolder(const std::string& name) {
  const std::string path = testing::TempDir() + "/belvedere_preproc_" + name;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path;
}

struct MadeRaster {
  int width = 0, height = 0, bands = 1;
  GDALDataType type = GDT_Float32;
  std::array<double, 6> affine{};
  int epsg = 4326;                                             // 0: none
  std::function<double(int band, int column, int row)> value;  // band from 1
  std::function<void(GDALDataset&)> finish = [](GDALDataset&) {};
};

inline std::string Write(const std::string& path, const MadeRaster& made) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GDALDataset* dataset = driver->Create(path.c_str(), made.width, made.height, made.bands, made.type, nullptr);
  if (made.epsg != 0) {
    std::array<double, 6> affine = made.affine;
    dataset->SetGeoTransform(affine.data());
    OGRSpatialReference crs;
    crs.importFromEPSG(made.epsg);
    dataset->SetSpatialRef(&crs);
  }
  made.finish(*dataset);
  for (int band = 1; band <= made.bands; ++band) {
    std::vector<double> line(static_cast<size_t>(made.width));
    for (int row = 0; row < made.height; ++row) {
      for (int column = 0; column < made.width; ++column)
        line[static_cast<size_t>(column)] = made.value(band, column, row);
      EXPECT_EQ(dataset->GetRasterBand(band)->RasterIO(GF_Write, 0, row, made.width, 1, line.data(), made.width, 1,
                                                       GDT_Float64, 0, 0, nullptr),
                CE_None);
    }
  }
  GDALClose(GDALDataset::ToHandle(dataset));
  return path;
}

// North-up, in degrees.
inline std::array<double, 6> Degrees(double west, double north, double pixel) {
  return {west, pixel, 0, north, 0, -pixel};
}

inline BuildReport MustBuild(const std::string& folder, const std::string& spec_text, int jobs = 2) {
  const auto spec = ParseSpec(spec_text, folder + "/spec.toml");
  EXPECT_TRUE(spec.ok()) << spec.message();
  BuildOptions options;
  options.out = folder + "/out";
  options.jobs = jobs;
  options.show_progress = false;
  auto report = Build(*spec, options, Clock::System());
  EXPECT_TRUE(report.ok()) << report.message();
  return report.ok() ? std::move(*report) : BuildReport{};
}

inline std::unique_ptr<Dataset> MustOpen(const std::string& folder) {
  auto dataset = Dataset::Open(folder + "/out");
  EXPECT_TRUE(dataset.ok()) << dataset.message();
  return dataset.ok() ? std::move(*dataset) : nullptr;
}

inline std::string Layer(const std::string& kind, const std::vector<std::string>& sources) {
  std::string text = "[[layer]]\nname = \"" + kind + "\"\nkind = \"" + kind + "\"\n";
  for (const std::string& source : sources) text += "[[layer.source]]\n" + source + "\n";
  return text;
}

}  // namespace belvedere::testing_rasters

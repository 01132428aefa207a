// How far a dataset's heights are from a source's, both bilinear, at random points: median, percentiles and largest.
//
//   height_accuracy DATASET SOURCE [--points N] [--seed K] [--outside WEST SOUTH EAST NORTH]
//
// SOURCE has a plain geotransform in degrees and heights above mean sea level (EGM96). --outside leaves out the points
// of a box, so that a coarse source can be compared where a finer one does not cover it.

#include "preproc/raster_reader.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/dataset.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <unordered_map>

namespace {

using namespace belvedere;

struct Source {
  std::array<double, 6> affine{};
  int width = 0, height = 0;
  std::vector<float> heights;

  double At(int column, int row) const {
    const bool global = std::abs(affine[1] * width - 360.0) < 0.01 * affine[1];
    column = global ? (column + width) % width : std::clamp(column, 0, width - 1);
    row = std::clamp(row, 0, height - 1);
    return static_cast<double>(
        heights[static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column)]);
  }
  double Bilinear(double latitude_deg, double longitude_deg) const {
    const double x = (longitude_deg - affine[0]) / affine[1] - 0.5;
    const double y = (latitude_deg - affine[3]) / affine[5] - 0.5;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const double fx = x - column, fy = y - row;
    return (At(column, row) * (1 - fx) + At(column + 1, row) * fx) * (1 - fy) +
           (At(column, row + 1) * (1 - fx) + At(column + 1, row + 1) * fx) * fy;
  }
};

Result<Source> LoadSource(const std::string& path) {
  GDALAllRegister();
  SourceSpec spec;
  spec.path = path;
  auto reader = RasterReader::Open(spec, LayerKind::kElevation, 1);
  if (!reader.ok()) return reader.status();
  Source source;
  (*reader)->dataset().GetGeoTransform(source.affine.data());
  source.width = (*reader)->width();
  source.height = (*reader)->height();
  Block block;
  int64_t bytes = 0;
  if (Status status = (*reader)->Read(0, 0, source.width, source.height, block, bytes); !status.ok()) return status;
  source.heights = std::move(block.heights);
  return source;
}

struct Options {
  std::string dataset_path, source_path;
  int points = 10000;
  unsigned seed = 1;
  std::vector<double> outside;
};

int Run(const Options& options) {
  const auto dataset = Dataset::Open(options.dataset_path);
  const auto source = LoadSource(options.source_path);
  const auto geoid = Geoid::LoadEgm96();
  for (const auto& message : {dataset.message(), source.message(), geoid.message()}) {
    if (!message.empty()) return fmt::print(stderr, "height_accuracy: {}\n", message), 1;
  }
  const int layer = (*dataset)->FindLayer(LayerKind::kElevation).value_or(0);
  std::unordered_map<Quadcode, std::shared_ptr<ElevationPage>> pages;
  std::mt19937 random(options.seed);
  // A pixel inside the outer edge, where there is something to interpolate between.
  const auto& affine = source->affine;
  std::uniform_real_distribution<double> east(affine[0] + affine[1], affine[0] + affine[1] * (source->width - 1));
  std::uniform_real_distribution<double> south(affine[3] + affine[5] * (source->height - 1), affine[3] + affine[5]);
  std::vector<double> differences;
  while (differences.size() < static_cast<size_t>(options.points)) {
    const double longitude = east(random), latitude = south(random);
    const auto& box = options.outside;
    if (box.size() == 4 && longitude >= box[0] && latitude >= box[1] && longitude <= box[2] && latitude <= box[3])
      continue;
    const Quadcode node = (*dataset)->FinestContaining(layer, latitude, longitude);
    auto& page = pages[node];
    if (!page) {
      auto read = (*dataset)->ReadElevation(layer, node);
      if (!read.ok()) return fmt::print(stderr, "height_accuracy: {}\n", read.message()), 1;
      page = std::move(*read);
    }
    const double wanted = source->Bilinear(latitude, longitude) + (*geoid)->Height(latitude, longitude);
    differences.push_back(std::abs(BilinearHeight(*page, node, latitude, longitude) - wanted));
  }
  std::sort(differences.begin(), differences.end());
  const auto at = [&](double share) {
    return differences[static_cast<size_t>(share * static_cast<double>(differences.size() - 1))];
  };
  fmt::print("{}: {} points: median {:.3f} m, 95th percentile {:.3f} m, 99th {:.3f} m, largest {:.3f} m\n",
             options.source_path, differences.size(), at(0.5), at(0.95), at(0.99), at(1.0));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"height_accuracy: a dataset's heights against a source's"};
  app.add_option("DATASET", options.dataset_path)->required();
  app.add_option("SOURCE", options.source_path)->required();
  app.add_option("--points", options.points)->check(CLI::Range(1, 100000000));
  app.add_option("--seed", options.seed);
  app.add_option("--outside", options.outside)->expected(4);
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}

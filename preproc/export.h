// Export: a layer as a file that other programs read, so that no data are locked into a dataset.
//
// FILE.tif is a cloud-optimised GeoTIFF with overviews, compressed without loss: heights as float32 above the ellipsoid
// at the posts, imagery with its alpha. FILE.mbtiles holds imagery as PNG in the tiles of the Web Mercator, each zoom
// level from the one whose pixels at the equator are no larger than the level's texels to the one that is a single
// tile. Both are written by GDAL from a LayerRaster, block by block: memory does not grow with the extent.
//
// The file is written beside its place and moved into it when it is whole.
//
// Threads: blocks the caller.
#pragma once

#include "preproc/export_grid.h"
#include "preproc/layer_pixels.h"
#include "runtime/base/clock.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <cstdint>
#include <optional>
#include <string>

namespace belvedere {

struct ExportOptions {
  std::string layer;  // its name; of a layer that changes with the time, that of a step
  std::string out;    // FILE.tif, FILE.tiff or FILE.mbtiles
  std::optional<GeoBox> extent{};
  std::optional<int> level{};
  Enlarge enlarge = Enlarge::kCoarser;
  bool show_progress = true;
};

struct ExportReport {
  ExportGrid grid;
  int64_t pages_read = 0;
  int64_t bytes = 0;  // of the file
  double seconds = 0;
};

Result<ExportReport> Export(const Dataset& dataset, const ExportOptions& options, const Clock& clock);
// "level 11, 4097 x 2049 posts, west .. east ..; 12.3 MB in 4.5 s"
std::string ExportReportLine(const ExportReport& report);

}  // namespace belvedere

// LayerRaster: a layer over a grid as a GDAL dataset to read from, so that every driver of GDAL can write it.
//
// Pixels are made block by block when they are asked for. Heights are one band of float32, in metres above the WGS 84
// ellipsoid: EPSG:4979, whose third axis says so; a pixel's centre is a post. Each is the stored millimetre rounded to
// a float, which to 16 km gives the millimetre back. Where there is none they are NaN, the nodata value. Imagery is
// four bands of bytes, red, green, blue and alpha, in EPSG:4326.
//
// Errors: a page that cannot be read is an error of GDAL's, and failure says which.
// Threads: one at a time, as any dataset of GDAL. The Dataset outlives it.
#pragma once

#include "preproc/export_grid.h"
#include "preproc/layer_pixels.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cstdint>

namespace belvedere {

class LayerRaster final : public GDALDataset {
 public:
  LayerRaster(const Dataset& dataset, int layer, const ExportGrid& grid, Enlarge enlarge);

  CPLErr GetGeoTransform(double* out) override;
  const OGRSpatialReference* GetSpatialRef() const override { return &crs_; }

  const ExportGrid& grid() const { return grid_; }
  const Status& failure() const { return failure_; }
  int64_t pages_read() const { return pixels_.pages_read(); }
  int64_t bytes_made() const { return bytes_made_; }

 private:
  friend class LayerBand;
  CPLErr Fail(const Status& status);
  // The posts or texels of a block, those outside the raster left out.
  PixelRange RangeOfBlock(int block_column, int block_row) const;
  CPLErr ReadHeights(int block_column, int block_row, float* out_m);
  // Fills the block of all four bands: this band's is out, the others go into GDAL's cache.
  CPLErr ReadColours(int block_column, int block_row, int band, uint8_t* out);

  const ExportGrid grid_;
  LayerPixels pixels_;
  OGRSpatialReference crs_;
  int64_t bytes_made_ = 0;
  Status failure_;  // the first
};

}  // namespace belvedere

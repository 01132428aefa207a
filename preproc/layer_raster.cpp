#include "preproc/layer_raster.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace belvedere {
namespace {

constexpr int kSide = 256;  // of a block
constexpr int kBands = 4;   // of imagery

}  // namespace

class LayerBand final : public GDALRasterBand {
 public:
  LayerBand(LayerRaster& raster, int number, GDALDataType type) : raster_(raster) {
    poDS = &raster;
    nBand = number;
    eDataType = type;
    nBlockXSize = kSide;
    nBlockYSize = kSide;
    eAccess = GA_ReadOnly;
    if (is_height()) GDALRasterBand::SetDescription("height above the WGS 84 ellipsoid");
  }

  CPLErr IReadBlock(int block_column, int block_row, void* out) override {
    return is_height() ? raster_.ReadHeights(block_column, block_row, static_cast<float*>(out))
                       : raster_.ReadColours(block_column, block_row, nBand, static_cast<uint8_t*>(out));
  }
  GDALColorInterp GetColorInterpretation() override {
    constexpr GDALColorInterp kColours[kBands] = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
    return is_height() ? GCI_GrayIndex : kColours[nBand - 1];
  }
  const char* GetUnitType() override { return is_height() ? "m" : ""; }
  double GetNoDataValue(int* has_nodata) override {
    if (has_nodata != nullptr) *has_nodata = is_height() ? 1 : 0;
    return is_height() ? std::numeric_limits<double>::quiet_NaN() : 0;
  }

 private:
  bool is_height() const { return eDataType == GDT_Float32; }

  LayerRaster& raster_;
};

LayerRaster::LayerRaster(const Dataset& dataset, int layer, const ExportGrid& grid, Enlarge enlarge)
    : grid_(grid), pixels_(dataset, layer, grid.level, enlarge) {
  nRasterXSize = grid.width;
  nRasterYSize = grid.height;
  eAccess = GA_ReadOnly;
  const bool heights = grid.kind == LayerKind::kElevation;
  crs_.importFromEPSG(heights ? 4979 : 4326);
  crs_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  for (int band = 1; band <= (heights ? 1 : kBands); ++band)
    SetBand(band, new LayerBand(*this, band, heights ? GDT_Float32 : GDT_Byte));
  const LayerRecord& record = dataset.layers()[static_cast<size_t>(layer)];
  const auto say = [this](const char* name, const std::string& value) {
    GDALDataset::SetMetadataItem(name, value.c_str());
  };
  say("AREA_OR_POINT", heights ? "Point" : "Area");
  say("BELVEDERE_LAYER", record.name);
  say("BELVEDERE_LEVEL", std::to_string(grid.level));
  say("BELVEDERE_DATASET_BUILT", dataset.build_time());
  if (heights) say("BELVEDERE_VERTICAL_REFERENCE", record.vertical_reference);
  if (!heights) GDALDataset::SetMetadataItem("INTERLEAVE", "PIXEL", "IMAGE_STRUCTURE");
}

CPLErr LayerRaster::GetGeoTransform(double* out) {
  const auto transform = grid_.GeoTransform();
  std::copy(transform.begin(), transform.end(), out);
  return CE_None;
}

CPLErr LayerRaster::Fail(const Status& status) {
  if (failure_.ok()) failure_ = status;
  CPLError(CE_Failure, CPLE_AppDefined, "%s", status.message().c_str());
  return CE_Failure;
}

PixelRange LayerRaster::RangeOfBlock(int block_column, int block_row) const {
  const int left = block_column * kSide, top = block_row * kSide;
  const int width = std::min(kSide, nRasterXSize - left), height = std::min(kSide, nRasterYSize - top);
  return {grid_.first_column + left, grid_.first_row + nRasterYSize - top - height, width, height};
}

CPLErr LayerRaster::ReadHeights(int block_column, int block_row, float* out_m) {
  const PixelRange range = RangeOfBlock(block_column, block_row);
  const auto width = static_cast<size_t>(range.width), height = static_cast<size_t>(range.height);
  std::vector<float> heights_m(width * height);
  if (const Status status = pixels_.ReadHeights(range, heights_m); !status.ok()) return Fail(status);
  for (size_t row = 0; row < height; ++row)  // the northernmost first
    std::copy_n(&heights_m[(height - 1 - row) * width], width, out_m + row * kSide);
  bytes_made_ += static_cast<int64_t>(heights_m.size() * sizeof(float));
  return CE_None;
}

CPLErr LayerRaster::ReadColours(int block_column, int block_row, int band, uint8_t* out) {
  const PixelRange range = RangeOfBlock(block_column, block_row);
  const auto width = static_cast<size_t>(range.width), height = static_cast<size_t>(range.height);
  std::vector<uint8_t> rgba(4 * width * height);
  if (const Status status = pixels_.ReadColours(range, rgba); !status.ok()) return Fail(status);
  bytes_made_ += static_cast<int64_t>(rgba.size());
  for (int other = 1; other <= kBands; ++other) {
    GDALRasterBlock* const block =
        other == band ? nullptr : GetRasterBand(other)->GetLockedBlockRef(block_column, block_row, TRUE);
    if (block == nullptr && other != band) return CE_Failure;  // GDAL has said why
    uint8_t* const plane = block == nullptr ? out : static_cast<uint8_t*>(block->GetDataRef());
    for (size_t row = 0; row < height; ++row) {
      const uint8_t* const texels = &rgba[4 * (height - 1 - row) * width];
      for (size_t column = 0; column < width; ++column)
        plane[row * kSide + column] = texels[4 * column + static_cast<size_t>(other - 1)];
    }
    if (block != nullptr) block->DropLock();
  }
  return CE_None;
}

}  // namespace belvedere

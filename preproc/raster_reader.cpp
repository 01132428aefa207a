#include "preproc/raster_reader.h"

#include "preproc/gdal_errors.h"
#include "preproc/mosaic.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace belvedere {
namespace {

// Heights outside are no heights on Earth: an undeclared nodata value, most likely.
constexpr double kLowestHeight_m = -20000;
constexpr double kHighestHeight_m = 100000;

double MetresPerUnit(std::string_view unit) {
  if (unit == "ft" || unit == "foot" || unit == "feet") return 0.3048;
  if (unit == "us-ft" || unit == "US survey foot" || unit == "sfoot" || unit == "ftUS") return 1200.0 / 3937.0;
  if (unit == "cm" || unit == "centimetre" || unit == "centimeter") return 0.01;
  if (unit == "km" || unit == "kilometre" || unit == "kilometer") return 1000.0;
  return 1.0;
}

bool SameNodata(double value, double nodata) {
  return value == nodata || static_cast<float>(value) == static_cast<float>(nodata);
}

}  // namespace

Result<std::unique_ptr<RasterReader>> RasterReader::Open(const SourceSpec& spec, LayerKind kind, int handles) {
  std::unique_ptr<RasterReader> reader(new RasterReader(spec, kind));
  auto path = PathToOpen(spec);
  if (!path.ok()) return path.status();
  reader->path_ = std::move(*path);
  auto first = reader->OpenHandle();
  if (!first.ok()) return first.status();
  reader->first_ = first->get();
  if (Status status = reader->Inspect(); !status.ok()) return status;
  const MutexLock lock(reader->mutex_);
  reader->handles_.push_back(std::move(*first));
  reader->may_open_ = reader->row_by_row_ ? 0 : handles - 1;
  return reader;
}

Result<DatasetHandle> RasterReader::OpenHandle() const {
  CPLErrorReset();
  GDALDataset* dataset = GDALDataset::Open(path_.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR);
  if (dataset == nullptr)
    return Status::Error("it cannot be opened ({}); check its path and the file", LastGdalError());
  return DatasetHandle(dataset);
}

Status RasterReader::Inspect() {
  GDALDataset& dataset = *first_;
  width_ = dataset.GetRasterXSize();
  height_ = dataset.GetRasterYSize();
  if (dataset.GetRasterCount() < 1 || width_ < 1 || height_ < 1) {
    return Status::Error("it has no raster band; name a subdataset in its path");
  }
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  int has_nodata = 0;
  const double own = band.GetNoDataValue(&has_nodata);
  nodata_ = spec_.nodata;
  if (!nodata_ && has_nodata != 0) nodata_ = own;
  has_mask_ = (band.GetMaskFlags() & GMF_PER_DATASET) != 0 && (band.GetMaskFlags() & GMF_ALPHA) == 0;
  for (int i = 2; i <= dataset.GetRasterCount(); ++i) {
    if (dataset.GetRasterBand(i)->GetColorInterpretation() == GCI_AlphaBand) alpha_band_ = i;
  }
  int block_width = 0, block_height = 0;
  band.GetBlockSize(&block_width, &block_height);
  const std::string driver = dataset.GetDriverName();
  row_by_row_ = block_width == width_ && (driver == "JPEG" || driver == "PNG" || driver == "GIF");
  if (kind_ == LayerKind::kImagery) return InspectColours();
  InspectHeights();
  return {};
}

void RasterReader::InspectHeights() {
  GDALRasterBand& band = *first_->GetRasterBand(1);
  OGRSpatialReference crs;
  if (spec_.crs)
    crs.SetFromUserInput(spec_.crs->c_str());
  else if (const OGRSpatialReference* own = first_->GetSpatialRef(); own != nullptr)
    crs = *own;
  declared_heights_ = HeightsDeclaredBy(crs);
  const std::string_view written = band.GetUnitType();
  const double unit = spec_.metres_per_unit ? *spec_.metres_per_unit
                      : written.empty()     ? declared_heights_.metres_per_unit.value_or(1.0)
                                            : MetresPerUnit(written);
  scale_ = band.GetScale() * unit;
  offset_ = band.GetOffset() * unit;
  if (GDALDataTypeIsInteger(band.GetRasterDataType()) != 0) precision_m_ = std::abs(scale_);
}

Status RasterReader::InspectColours() {
  GDALDataset& dataset = *first_;
  const int bands = dataset.GetRasterCount();
  const int colours = bands - (alpha_band_ != 0 ? 1 : 0);
  if (colours == 2) remark_ = "its second band is not said to be alpha and is left out";
  colour_bands_ = colours >= 3 ? std::vector<int>{1, 2, 3} : std::vector<int>{1};
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if (const GDALColorTable* table = band.GetColorTable(); table != nullptr && colours < 3) {
    palette_.resize(256);
    for (int i = 0; i < std::min(256, table->GetColorEntryCount()); ++i) {
      const GDALColorEntry* entry = table->GetColorEntry(i);
      palette_[static_cast<size_t>(i)] = {static_cast<uint8_t>(entry->c1), static_cast<uint8_t>(entry->c2),
                                          static_cast<uint8_t>(entry->c3), static_cast<uint8_t>(entry->c4)};
    }
    return {};
  }
  if (band.GetRasterDataType() == GDT_Byte) return {};
  double low_high[2] = {0, 0};
  if (band.ComputeRasterMinMax(TRUE, low_high) != CE_None) {
    return Status::Error("its range of values cannot be read: {}", LastGdalError());
  }
  scale_ = low_high[1] > low_high[0] ? 255.0 / (low_high[1] - low_high[0]) : 1.0;
  offset_ = -low_high[0] * scale_;
  if (!remark_.empty()) remark_ += "; ";
  remark_ += fmt::format("its values are not 8-bit; {} to {} was stretched to 0 to 255", low_high[0], low_high[1]);
  return {};
}

DatasetHandle RasterReader::Borrow(Status& status) {
  {
    const MutexLock lock(mutex_);
    while (handles_.empty() && may_open_ == 0) returned_.Wait(mutex_);
    if (!handles_.empty()) {
      DatasetHandle handle = std::move(handles_.back());
      handles_.pop_back();
      return handle;
    }
    --may_open_;
  }
  auto opened = OpenHandle();
  if (!opened.ok()) {
    status = opened.status();
    const MutexLock lock(mutex_);
    ++may_open_;
    returned_.NotifyOne();
    return nullptr;
  }
  return std::move(*opened);
}

void RasterReader::Return(DatasetHandle handle) {
  const MutexLock lock(mutex_);
  handles_.push_back(std::move(handle));
  returned_.NotifyOne();
}

Status RasterReader::Read(int x, int y, int width, int height, Block& out, int64_t& bytes) {
  Status status;
  DatasetHandle handle = Borrow(status);
  if (!handle) return status;
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  out.coverage.assign(pixels, 255);
  const std::array<int, 4> window{x, y, width, height};
  CPLErrorReset();
  status = kind_ == LayerKind::kElevation ? ReadHeights(*handle, window, out, bytes)
                                          : ReadColours(*handle, window, out, bytes);
  if (status.ok() && has_mask_) status = ReadMask(*handle, window, out);
  Return(std::move(handle));
  return status;
}

Status RasterReader::ReadHeights(GDALDataset& dataset, const std::array<int, 4>& window, Block& out,
                                 int64_t& bytes) const {
  const auto [x, y, width, height] = window;
  std::vector<double> values(out.coverage.size());
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if (band.RasterIO(GF_Read, x, y, width, height, values.data(), width, height, GDT_Float64, 0, 0, nullptr) !=
      CE_None) {
    return Status::Error("it is truncated or damaged: {}", LastGdalError());
  }
  bytes += static_cast<int64_t>(values.size()) * GDALGetDataTypeSizeBytes(band.GetRasterDataType());
  out.heights.resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const double height_m = values[i] * scale_ + offset_;
    const bool good = std::isfinite(values[i]) && !(nodata_ && SameNodata(values[i], *nodata_)) &&
                      height_m >= kLowestHeight_m && height_m <= kHighestHeight_m;
    out.heights[i] = good ? static_cast<float>(height_m) : 0.0f;
    if (!good) out.coverage[i] = 0;
  }
  if (alpha_band_ == 0) return {};
  return ReadAlpha(dataset, window, out);
}

Status RasterReader::ReadColours(GDALDataset& dataset, const std::array<int, 4>& window, Block& out,
                                 int64_t& bytes) const {
  const auto [x, y, width, height] = window;
  const size_t pixels = out.coverage.size();
  const size_t bands = colour_bands_.size();
  out.colours.resize(3 * pixels);
  const bool is_byte = dataset.GetRasterBand(1)->GetRasterDataType() == GDT_Byte;
  bytes +=
      static_cast<int64_t>(bands * pixels) * GDALGetDataTypeSizeBytes(dataset.GetRasterBand(1)->GetRasterDataType());
  std::vector<float> wide(is_byte ? 0 : bands * pixels);
  std::vector<uint8_t> narrow(is_byte ? bands * pixels : 0);
  void* target = is_byte ? static_cast<void*>(narrow.data()) : static_cast<void*>(wide.data());
  const GSpacing size = is_byte ? 1 : 4;
  std::vector<int> list = colour_bands_;
  if (dataset.RasterIO(GF_Read, x, y, width, height, target, width, height, is_byte ? GDT_Byte : GDT_Float32,
                       static_cast<int>(bands), list.data(), size * static_cast<GSpacing>(bands),
                       size * static_cast<GSpacing>(bands) * width, size, nullptr) != CE_None) {
    return Status::Error("it is truncated or damaged: {}", LastGdalError());
  }
  for (size_t i = 0; i < pixels; ++i) {
    bool empty = true;
    for (size_t c = 0; c < 3; ++c) {
      const size_t at = bands * i + (bands == 3 ? c : 0);
      const double value = is_byte ? narrow[at] : static_cast<double>(wide[at]);
      empty = empty && (!std::isfinite(value) || (nodata_ && SameNodata(value, *nodata_)));
      if (is_byte) {
        out.colours[3 * i + c] = narrow[at];
      } else if (std::isfinite(value)) {
        out.colours[3 * i + c] = static_cast<uint8_t>(std::clamp(value * scale_ + offset_, 0.0, 255.0) + 0.5);
      }
    }
    if (empty) out.coverage[i] = 0;
    if (!palette_.empty()) {
      const auto& entry = palette_[out.colours[3 * i]];
      std::copy_n(entry.begin(), 3, &out.colours[3 * i]);
      if (!empty) out.coverage[i] = entry[3];
    }
  }
  if (alpha_band_ == 0) return {};
  return ReadAlpha(dataset, window, out);
}

Status RasterReader::ReadAlpha(GDALDataset& dataset, const std::array<int, 4>& window, Block& out) const {
  const auto [x, y, width, height] = window;
  GDALRasterBand& band = *dataset.GetRasterBand(alpha_band_);
  // As GDAL's warper writes it.
  const GDALDataType type = band.GetRasterDataType();
  const float scale = 255.0F / (type == GDT_UInt16 ? 65535.0F : type == GDT_Int16 ? 32767.0F : 255.0F);
  std::vector<float> alpha(out.coverage.size());
  if (band.RasterIO(GF_Read, x, y, width, height, alpha.data(), width, height, GDT_Float32, 0, 0, nullptr) != CE_None) {
    return Status::Error("it is truncated or damaged: {}", LastGdalError());
  }
  for (size_t i = 0; i < alpha.size(); ++i) {
    const auto share = static_cast<uint8_t>(std::clamp(alpha[i] * scale, 0.0F, 255.0F) + 0.5F);
    out.coverage[i] = std::min(out.coverage[i], share);
  }
  return {};
}

Status RasterReader::ReadMask(GDALDataset& dataset, const std::array<int, 4>& window, Block& out) const {
  const auto [x, y, width, height] = window;
  std::vector<uint8_t> mask(out.coverage.size());
  if (dataset.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Read, x, y, width, height, mask.data(), width, height,
                                                        GDT_Byte, 0, 0, nullptr) != CE_None) {
    return Status::Error("its mask is truncated or damaged: {}", LastGdalError());
  }
  for (size_t i = 0; i < mask.size(); ++i) out.coverage[i] = std::min(out.coverage[i], mask[i]);
  return {};
}

}  // namespace belvedere

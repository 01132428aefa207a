// RasterReader: pixels out of a GDAL dataset as heights or colours with coverage, whatever its bands, types, palette,
// masks, alpha, nodata, scale and unit.
//
// Threads: Read, any thread; each call borrows a handle, of which there are at most as many as asked for. Formats that
// can only be read from the top down have one.
#pragma once

#include "preproc/raster_source.h"
#include "preproc/spec.h"
#include "preproc/vertical_datum.h"
#include "runtime/base/mutex.h"
#include "runtime/base/status.h"

#include <gdal_priv.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace belvedere {

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(GDALDataset::ToHandle(dataset)); }
};
using DatasetHandle = std::unique_ptr<GDALDataset, DatasetCloser>;

class RasterReader {
 public:
  static Result<std::unique_ptr<RasterReader>> Open(const SourceSpec& spec, LayerKind kind, int handles);

  GDALDataset& dataset() { return *first_; }  // REQUIRES: nobody reads yet
  int width() const { return width_; }
  int height() const { return height_; }
  std::optional<double> nodata() const { return nodata_; }
  const std::string& remark() const { return remark_; }
  // Elevation: what its CRS, or the spec's for it, says of heights.
  const DeclaredHeights& declared_heights() const { return declared_heights_; }
  // Elevation: the step between two heights, where pixels are integers; 0 where they are not.
  double precision_m() const { return precision_m_; }
  // Whether a whole row of blocks is best read at once.
  bool row_by_row() const { return row_by_row_; }

  // The window as a Block of width x height pixels (not of kBlockSide). Adds to bytes the size of the pixels read.
  Status Read(int x, int y, int width, int height, Block& out, int64_t& bytes);

 private:
  explicit RasterReader(const SourceSpec& spec, LayerKind kind) : spec_(spec), kind_(kind) {}
  Result<DatasetHandle> OpenHandle() const;
  Status Inspect();
  void InspectHeights();
  Status InspectColours();
  DatasetHandle Borrow(Status& status) EXCLUDES_LOCK(mutex_);
  void Return(DatasetHandle handle) EXCLUDES_LOCK(mutex_);
  Status ReadHeights(GDALDataset& dataset, const std::array<int, 4>& window, Block& out, int64_t& bytes) const;
  Status ReadColours(GDALDataset& dataset, const std::array<int, 4>& window, Block& out, int64_t& bytes) const;
  Status ReadAlpha(GDALDataset& dataset, const std::array<int, 4>& window, Block& out) const;
  Status ReadMask(GDALDataset& dataset, const std::array<int, 4>& window, Block& out) const;

  const SourceSpec spec_;
  const LayerKind kind_;
  std::string path_;              // that GDAL opens
  GDALDataset* first_ = nullptr;  // the first of the handles, for whoever inspects before anybody reads
  int width_ = 0, height_ = 0;
  std::optional<double> nodata_;
  double scale_ = 1, offset_ = 0;  // heights: to metres; colours: to 0..255
  double precision_m_ = 0;
  std::vector<int> colour_bands_;  // 1 (grey or palette) or 3
  int alpha_band_ = 0;             // 0: none
  bool has_mask_ = false;
  std::vector<std::array<uint8_t, 4>> palette_;
  bool row_by_row_ = false;
  std::string remark_;
  DeclaredHeights declared_heights_;

  Mutex mutex_;
  CondVar returned_;
  std::vector<DatasetHandle> handles_ GUARDED_BY(mutex_);  // those that nobody holds
  int may_open_ GUARDED_BY(mutex_) = 0;
};

}  // namespace belvedere

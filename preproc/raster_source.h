// RasterSource: one opened source and its pixels, in blocks of a pyramid that is made as it is needed.
//
// Level 0 of the pyramid is the source itself, each level above it half the side: the coverage-weighted mean of 2 x 2
// pixels, so that nothing aliases when a source is shrunk a lot. A pixel's coverage is 0 where it is nodata, masked,
// transparent, NaN or no height on Earth, 255 where it is whole. Blocks are cached within a byte budget that all
// sources share; reading needs as many GDAL handles as there are threads inside, no more.
//
// Units: elevation in the source's metres (unit, scale and offset applied, datum not); imagery 8-bit RGB.
// Threads: all methods, any thread.
#pragma once

#include "preproc/block_cache.h"
#include "preproc/georeference.h"
#include "preproc/spec.h"
#include "preproc/void_map.h"
#include "runtime/base/mutex.h"
#include "runtime/base/status.h"
#include "runtime/earth/geoid.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace belvedere {

class RasterReader;  // the GDAL side

class RasterSource {
 public:
  // number is the source's own among those that share the cache, under 2^16. Fails with the reason alone.
  static Result<std::unique_ptr<RasterSource>> Open(const SourceSpec& spec, LayerKind kind, int number, int handles,
                                                    BlockCache& cache);
  ~RasterSource();

  const SourceSpec& spec() const { return spec_; }
  SourceRecord Record() const;
  const Georeference& georeference() const { return *georeference_; }
  int width(int pyramid_level) const { return ShrunkSide(width_, pyramid_level); }
  int height(int pyramid_level) const { return ShrunkSide(height_, pyramid_level); }
  // Levels under which a source that goes round the Earth still closes on itself.
  int pyramid_levels() const { return pyramid_levels_; }
  std::shared_ptr<const Block> GetBlock(int pyramid_level, int column, int row);
  // The pixels that are the source's own, as a block of coverage alone: 255 where all that lies under a pixel is valid,
  // however transparent, or of elevation in a void, 0 where nothing is, between the two the share of it that is.
  std::shared_ptr<const Block> GetDomain(int pyramid_level, int column, int row);

  // Elevation: whether anything is missing within; the first call reads the whole source.
  bool HasVoids() { return !Voids().empty(); }

  // What could not be read, if anything: the source is then to be left out.
  Status failure() const EXCLUDES_LOCK(failure_mutex_);
  // Elevation: whether DatumHeights needs to know of mean sea level.
  bool is_above_sea_level() const { return datum_ == VerticalDatum::kEgm96; }
  // Elevation: how far above the ellipsoid the source's zero lies, where mean sea level by EGM96 is as far above it as
  // `undulation_m` says: every latitude with every longitude, row by row. NaN where its datum has no value.
  std::vector<double> DatumHeights(std::span<const double> latitudes_deg, std::span<const double> longitudes_deg,
                                   const std::vector<double>& undulation_m) const;

  // Elevation: the step between two heights, where pixels are integers; 0 where they are not.
  double precision_m() const;
  // What was done to the pixels that the user may not expect; may be empty.
  const std::string& remark() const { return remark_; }
  // Of its files when it was opened (source_settings.h), and where its pixels lie: the same where nothing has changed.
  const std::string& state() const { return state_; }
  // Whether any pixel is valid; reads the whole source.
  bool HasData();
  // What is done to the colours of its pixels as pages are made. Set before any is.
  const std::optional<ColourFit>& colour_fit() const { return colour_fit_; }
  void SetColourFit(const ColourFit& fit) { colour_fit_ = fit; }
  bool used() const { return used_.load(std::memory_order_relaxed); }
  void SetUsed() { used_.store(true, std::memory_order_relaxed); }
  int64_t bytes_read() const { return bytes_read_.load(std::memory_order_relaxed); }

 private:
  RasterSource(const SourceSpec& spec, LayerKind kind, int number, BlockCache& cache);
  static int ShrunkSide(int side, int level) {
    return static_cast<int>((int64_t{side} + (int64_t{1} << level) - 1) >> level);
  }
  enum class Plane { kPixels, kDomain };
  uint64_t KeyOf(Plane plane, int pyramid_level, int column, int row) const;
  std::shared_ptr<const Block> ReadFromFile(int column, int row);
  std::shared_ptr<const Block> Shrink(Plane plane, int pyramid_level, int column, int row);
  std::shared_ptr<const Block> DomainOf(int column, int row);
  Status FindDatum();
  const VoidMap& Voids();
  VoidMap FindVoids();
  void Fail(Status status) EXCLUDES_LOCK(failure_mutex_);

  const SourceSpec spec_;
  const LayerKind kind_;
  const int number_;
  BlockCache& cache_;
  std::unique_ptr<RasterReader> reader_;
  std::unique_ptr<Georeference> georeference_;
  int width_ = 0, height_ = 0;
  int pyramid_levels_ = 0;
  std::optional<ColourFit> colour_fit_;
  VerticalDatum datum_ = VerticalDatum::kEgm96;  // never kDeclared
  std::shared_ptr<const Geoid> datum_grid_;      // for kGrid
  std::string datum_name_;
  std::string remark_;
  int voids_level_ = 0;  // of the pyramid, that voids_ is of
  std::once_flag voids_found_;
  VoidMap voids_;  // once they are found
  std::string state_;
  std::atomic<bool> used_{false};
  std::atomic<int64_t> bytes_read_{0};
  mutable Mutex failure_mutex_;
  Status failure_ GUARDED_BY(failure_mutex_);
};

}  // namespace belvedere

// SourceSampler: a source's values at the positions of a lattice, filtered for the distance between them.
//
// A value depends on its own position, the distance between positions and the source, and on nothing else: two pages
// that hold the same position of the same level get the same bits.
//
// Threads: one sampler a thread; the source is shared.
#pragma once

#include "preproc/feather.h"
#include "preproc/lattice.h"
#include "preproc/raster_source.h"
#include "preproc/resample.h"

#include <memory>
#include <span>
#include <vector>

namespace belvedere {

// Row by row, latitudes by longitudes; interleaved.
template <typename Number>
struct Samples {
  size_t channels = 1;
  std::vector<Number> values;  // channels a position
  std::vector<float> weights;  // how much of the position the source covers, feathered: 0 to 1
  // Heights: the same, were the source's voids filled, of positions in them, else 0; empty where there are none.
  std::vector<float> void_weights;
};

class SourceSampler {
 public:
  SourceSampler(RasterSource& source, LayerKind kind);

  RasterSource& source() const { return source_; }
  const GeoBox& extent() const { return georeference_->extent(); }
  // spacing: between posts or texels of the level. Number is double for heights, float for colours.
  template <typename Number>
  Samples<Number> Sample(const LatticeRows& lattice, const Spacing& spacing, bool feathered = true);

 private:
  struct Scale {
    int pyramid_level = 0;
    double shrink_x = 1, shrink_y = 1;  // pixels of that level between positions
    bool operator==(const Scale&) const = default;
  };
  // Pixel coordinates at level 0, NaN off the source: of the columns and of the rows where the source is separable,
  // else of every position.
  struct Positions {
    std::vector<double> x, y;
  };

  Scale ScaleAt(double latitude_deg, const Spacing& spacing);
  // Of a pixel of level 0, measured at the source's middle longitude.
  PixelSize PixelSizeAt(double latitude_deg);
  Positions PositionsOf(const LatticeRows& lattice, size_t first_row, size_t rows);
  static std::vector<double> AxisAtLevel(std::vector<double> axis, int pyramid_level);
  bool IsOnSource(const Positions& positions, size_t columns, size_t i) const;
  enum class Plane { kPixels, kDomain };  // of the domain the coverage alone
  // Pixels of a block from `at` on, as a window has them.
  void CopyPixels(const Block& block, size_t at, size_t count, Plane plane, float* out) const;
  PixelWindow MakeWindow(int pyramid_level, const AxisTaps& x, const AxisTaps& y, Plane plane) const;
  template <typename Number>
  std::vector<Number> Filter(const Positions& positions, const Scale& scale, Kernel kernel, Plane plane) const;
  template <typename Number>
  std::vector<Number> FilterHeights(const Positions& positions, const Scale& scale) const;
  // Sets weights, one a position, to 1 where the position lies in a void and no height is.
  void FindVoids(const Positions& positions, const Scale& scale, std::span<const float> weights,
                 std::span<float> void_weights) const;
  // The feather of rows of a lattice, from its first_row on, one weight a position.
  std::vector<float> FeatherOf(const LatticeRows& lattice, size_t first_row, size_t rows, const Positions& positions,
                               const Scale& scale);
  // The domain round positions at a pyramid level, margin_x and margin_y pixels further than they reach.
  DomainWindow MakeDomainWindow(int pyramid_level, const Positions& at_level, int margin_x, int margin_y) const;
  void PrepareFeather();
  int FeatherLevel();

  RasterSource& source_;
  const LayerKind kind_;
  const size_t channels_;
  std::unique_ptr<Georeference> georeference_;
  int feather_level_ = 0;
  // Of a source that goes round the Earth: what lies beyond its first or last row is not another's.
  bool first_row_is_pole_ = false, last_row_is_pole_ = false;
};

}  // namespace belvedere

// ExportGrid: which posts or texels of a layer a raster takes, and where they lie.
//
// Of heights a pixel's centre is a post, so that what is exported is what is stored; of imagery a pixel is a texel. The
// grid is that of one level: posts 45 / 128 / 2^level degrees apart, texels 45 / 248 / 2^level. An extent is widened to
// whole cells between posts, or texels. What goes once round the Earth holds no post twice.
//
// Units: degrees. Columns are counted from 180 W, rows from 90 S; posts on both poles count.
// Threads: values and pure functions.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <array>
#include <cstdint>
#include <optional>

namespace belvedere {

struct ExportGrid {
  LayerKind kind = LayerKind::kElevation;
  int level = 0;
  int64_t first_column = 0;  // the westernmost, 0 .. once round; the columns run on past 180 E
  int64_t first_row = 0;     // the southernmost
  int width = 0, height = 0;

  int CellsPerNode() const;  // columns of a quadnode of the level, and rows
  double SpacingDegrees() const;
  // GDAL's: the outer corner of the first pixel, in the north-west, and the steps from pixel to pixel.
  std::array<double, 6> GeoTransform() const;
  // Of the posts, or of the outer edges of the texels; west in [-180, 180).
  GeoBox Box() const;
};

// extent: nullopt for the smallest that holds all pages of the level. level: nullopt for the finest that has a page in
// the extent. An extent's east may be under its west, or over 180, where it goes over 180 E. Fails with the reason
// alone: an extent off the Earth, a level that has no page in it, or more pixels than a raster can have.
Result<ExportGrid> PlanExport(const Dataset& dataset, int layer, std::optional<GeoBox> extent,
                              std::optional<int> level);

}  // namespace belvedere

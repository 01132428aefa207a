// How a SourceSampler finds the weights of its source's feather.

#include "preproc/source_sampler.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/post_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace belvedere {
namespace {

constexpr double kMostFeatherPixels = 48;  // over which a feather reaches, at the pyramid level where it is measured
constexpr int kMostFeatherColumns = 2048;  // near a pole, where columns are narrow
constexpr uint8_t kHalfInside = 128;

// The pixels that positions lie in, first to last.
struct Span {
  int first = 0, length = 0;
};
Span SpanOf(const std::vector<double>& positions) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double position : positions) {
    if (std::isnan(position)) continue;
    least = std::min(least, position);
    most = std::max(most, position);
  }
  if (least > most) return {};
  const int first = static_cast<int>(std::floor(least));
  return {first, static_cast<int>(std::floor(most)) - first + 1};
}

}  // namespace

PixelSize SourceSampler::PixelSizeAt(double latitude_deg) {
  const GeoBox& box = extent();
  const double margin = 0.02 * (box.north_deg - box.south_deg);
  const double lat = std::clamp(latitude_deg, box.south_deg + margin, box.north_deg - margin);
  const double lon = (box.west_deg + box.east_deg) / 2;
  const double step = georeference_->spacing_deg() / 2;
  const double north_step = lat + step > 90 ? -step : step;
  const PixelPoint here = georeference_->ToPixel(lon, lat);
  const PixelPoint east = georeference_->ToPixel(lon + step, lat);
  const PixelPoint north = georeference_->ToPixel(lon, lat + north_step);
  const RowGeometry parallel = RowAt(lat);
  const double east_m = step * kRadiansPerDegree * parallel.prime_vertical_m * parallel.cos_latitude;
  const double north_m = north_step * kRadiansPerDegree * parallel.meridian_m;
  // Pixels a metre, and the inverse of that matrix.
  const double xe = (east.x - here.x) / east_m, xn = (north.x - here.x) / north_m;
  const double ye = (east.y - here.y) / east_m, yn = (north.y - here.y) / north_m;
  const double determinant = std::abs(xe * yn - xn * ye);
  if (std::isfinite(determinant) && determinant > 0)
    return {std::hypot(yn, ye) / determinant, std::hypot(xn, xe) / determinant};
  const double pixel_m = georeference_->spacing_deg() * kRadiansPerDegree * kEquatorialRadius_m;
  return {pixel_m, pixel_m};
}

// The pyramid level at which a feather is so few pixels wide that looking for the border is quick.
int SourceSampler::FeatherLevel() {
  const PixelSize size = PixelSizeAt((extent().south_deg + extent().north_deg) / 2);
  const double pixels = source_.spec().feather_m / std::min(size.x_m, size.y_m);
  const int level = static_cast<int>(std::ceil(std::log2(std::max(pixels / kMostFeatherPixels, 1.0))));
  return std::min(level, source_.pyramid_levels());
}

DomainWindow SourceSampler::MakeDomainWindow(int pyramid_level, const Positions& at_level, int margin_x,
                                             int margin_y) const {
  const Span across = SpanOf(at_level.x), down = SpanOf(at_level.y);
  if (across.length == 0 || down.length == 0) return {};
  const int width = source_.width(pyramid_level), height = source_.height(pyramid_level);
  // A pixel on the border of what is off the source is all it takes.
  const bool wraps = georeference_->wraps();
  const int first_x = wraps ? across.first - margin_x : std::max(across.first - margin_x, -1);
  const int end_x = across.first + across.length + margin_x;
  const int first_y = std::max(down.first - margin_y, -1);
  const int end_y = std::min(down.first + down.length + margin_y, height + 1);
  DomainWindow window{first_x, first_y, (wraps ? end_x : std::min(end_x, width + 1)) - first_x, end_y - first_y, {}};
  window.inside.assign(static_cast<size_t>(window.width) * static_cast<size_t>(window.height), 0);
  std::shared_ptr<const Block> block;
  int block_column = -1, block_row = -1;
  uint8_t* out = window.inside.data();
  for (int j = 0; j < window.height; ++j) {
    const int row = window.y + j;
    for (int i = 0; i < window.width; ++i, ++out) {
      const int wanted = window.x + i;
      const int column = wraps ? ((wanted % width) + width) % width : wanted;
      if (row < 0 || row >= height) {
        *out = row < 0 ? first_row_is_pole_ : last_row_is_pole_;
        continue;
      }
      if (column < 0 || column >= width) continue;
      if (column / kBlockSide != block_column || row / kBlockSide != block_row) {
        block_column = column / kBlockSide;
        block_row = row / kBlockSide;
        block = source_.GetDomain(pyramid_level, block_column, block_row);
      }
      *out = block->coverage[static_cast<size_t>(row % kBlockSide * kBlockSide + column % kBlockSide)] >= kHalfInside;
    }
  }
  return window;
}

std::vector<float> SourceSampler::FeatherOf(const LatticeRows& lattice, size_t first_row, size_t rows,
                                            const Positions& positions, const Scale& scale) {
  const int level = std::max(feather_level_, scale.pyramid_level);
  const size_t columns = lattice.longitudes_deg.size();
  const double feather_m = source_.spec().feather_m;
  std::vector<PixelSize> sizes;
  PixelSize least{feather_m, feather_m};
  for (size_t j = first_row; j < first_row + rows; ++j) {
    const PixelSize size = PixelSizeAt(lattice.latitudes_deg[j]);
    sizes.push_back({std::ldexp(size.x_m, level), std::ldexp(size.y_m, level)});
    least = {std::min(least.x_m, sizes.back().x_m), std::min(least.y_m, sizes.back().y_m)};
  }
  const auto margin = [&](double pixel_m) {
    return static_cast<int>(std::min(std::ceil(feather_m / pixel_m) + 1, double{kMostFeatherColumns}));
  };
  const Positions at_level{AxisAtLevel(positions.x, level), AxisAtLevel(positions.y, level)};
  std::vector<float> weights(columns * rows, 1.0f);
  DomainWindow window = MakeDomainWindow(level, at_level, margin(least.x_m), margin(least.y_m));
  if (window.inside.empty()) return weights;
  const Feather feather(std::move(window));
  if (feather.whole()) return weights;
  const bool separable = georeference_->separable();
  for (size_t i = 0; i < weights.size(); ++i) {
    if (!IsOnSource(at_level, columns, i)) continue;
    const double x = at_level.x[separable ? i % columns : i], y = at_level.y[separable ? i / columns : i];
    weights[i] = feather.WeightAt(x, y, sizes[i / columns], feather_m);
  }
  return weights;
}

void SourceSampler::PrepareFeather() {
  feather_level_ = FeatherLevel();
  if (!georeference_->wraps()) return;
  for (const double pole_deg : {-90.0, 90.0}) {
    const double y = georeference_->ToPixel(extent().west_deg, pole_deg).y;
    first_row_is_pole_ |= std::abs(y) <= 1;
    last_row_is_pole_ |= std::abs(y - source_.height(0)) <= 1;
  }
}

}  // namespace belvedere

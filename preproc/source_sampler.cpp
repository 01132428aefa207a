#include "preproc/source_sampler.h"

#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kWidestShrink = 64;      // pixels of a pyramid level between positions, at most
constexpr float kLeastCoverage = 0.499f;  // of a height, for it to count; half a pixel's worth
constexpr double kMetresPerDegree = kEquatorialRadius_m * kRadiansPerDegree;

// Position on the source, or none.
double OnAxis(double position, int length) {
  return position >= 0 && position <= length ? position : kNaN;
}

// Quarter octaves, so that rows of nearly one scale are filtered together; all enlarging is one.
double Rounded(double shrink) {
  return shrink <= 1 ? 1.0 : std::min(std::exp2(std::ceil(4 * std::log2(shrink) - 1e-6) / 4), kWidestShrink);
}

}  // namespace

SourceSampler::SourceSampler(RasterSource& source, LayerKind kind)
    : source_(source),
      kind_(kind),
      channels_(kind == LayerKind::kElevation ? 1 : 3),
      georeference_(source.georeference().Clone()) {}

// Pixels between positions, measured at the source's middle longitude, and the pyramid level to take them from.
SourceSampler::Scale SourceSampler::ScaleAt(double latitude_deg, double spacing_deg) {
  const GeoBox& box = extent();
  const double margin = 0.02 * (box.north_deg - box.south_deg);
  const double lat = std::clamp(latitude_deg, box.south_deg + margin, box.north_deg - margin);
  const double lon = (box.west_deg + box.east_deg) / 2;
  const double step = georeference_->spacing_deg() / 2;
  const PixelPoint here = georeference_->ToPixel(lon, lat);
  const PixelPoint east = georeference_->ToPixel(lon + step, lat);
  const PixelPoint north = georeference_->ToPixel(lon, lat + (lat + step > 90 ? -step : step));
  double x = std::max(std::abs(east.x - here.x), std::abs(north.x - here.x)) / step * spacing_deg;
  double y = std::max(std::abs(east.y - here.y), std::abs(north.y - here.y)) / step * spacing_deg;
  if (!std::isfinite(x) || !std::isfinite(y)) x = y = spacing_deg / georeference_->spacing_deg();
  Scale scale;
  const double least = std::min(x, y);
  if (least >= 2) scale.pyramid_level = std::min(static_cast<int>(std::log2(least)), source_.pyramid_levels());
  scale.shrink_x = Rounded(std::ldexp(x, -scale.pyramid_level));
  scale.shrink_y = Rounded(std::ldexp(y, -scale.pyramid_level));
  return scale;
}

// For a separable source: the columns' x in the first points' x and the rows' y in their own first point.
std::vector<PixelPoint> SourceSampler::PixelsOf(const LatticeRows& lattice, size_t first_row, size_t rows) {
  const size_t columns = lattice.longitudes_deg.size();
  std::vector<double> longitudes(columns * rows), latitudes(columns * rows);
  for (size_t j = 0; j < rows; ++j) {
    for (size_t i = 0; i < columns; ++i) {
      longitudes[j * columns + i] = lattice.longitudes_deg[i];
      latitudes[j * columns + i] = lattice.latitudes_deg[first_row + j];
    }
  }
  std::vector<PixelPoint> points(columns * rows);
  georeference_->ToPixels(longitudes, latitudes, points);
  const int width = source_.width(0);
  const int height = source_.height(0);
  for (PixelPoint& point : points) {
    point = {OnAxis(point.x, width), OnAxis(point.y, height)};
    if (!georeference_->separable() && std::isnan(point.x + point.y)) point = {kNaN, kNaN};
  }
  return points;
}

PixelWindow SourceSampler::MakeWindow(int pyramid_level, const AxisTaps& x, const AxisTaps& y, Edge edge) const {
  PixelWindow window{x.lowest, y.lowest, x.length, y.length, channels_, {}};
  const size_t size = channels_ + 1;
  window.pixels.assign(static_cast<size_t>(x.length) * static_cast<size_t>(y.length) * size, 0.0f);
  const int width = source_.width(pyramid_level);
  const int height = source_.height(pyramid_level);
  const bool wraps = georeference_->wraps();
  std::shared_ptr<const Block> block;
  int block_column = -1, block_row = -1;
  float* out = window.pixels.data();
  for (int j = 0; j < window.height; ++j) {
    const int row = std::clamp(window.y + j, 0, height - 1);
    for (int i = 0; i < window.width; ++i, out += size) {
      const int wanted = window.x + i;
      const int column = wraps ? ((wanted % width) + width) % width : std::clamp(wanted, 0, width - 1);
      if (edge == Edge::kEmpty && (row != window.y + j || (!wraps && column != wanted))) continue;
      if (column / kBlockSide != block_column || row / kBlockSide != block_row) {
        block_column = column / kBlockSide;
        block_row = row / kBlockSide;
        block = source_.GetBlock(pyramid_level, block_column, block_row);
      }
      const auto at = static_cast<size_t>(row % kBlockSide * kBlockSide + column % kBlockSide);
      const float coverage = static_cast<float>(block->coverage[at]) / 255.0f;
      if (kind_ == LayerKind::kElevation) {
        out[0] = block->heights[at] * coverage;
      } else {
        for (size_t c = 0; c < 3; ++c) out[c] = static_cast<float>(block->colours[3 * at + c]) * coverage;
      }
      out[channels_] = coverage;
    }
  }
  return window;
}

template <typename Number>
std::vector<Number> SourceSampler::Filter(std::span<const PixelPoint> points, size_t columns, const Scale& scale,
                                          Kernel kernel, Edge edge) {
  const bool separable = georeference_->separable();
  const size_t rows = points.size() / columns;
  std::vector<double> x(separable ? columns : points.size()), y(separable ? rows : points.size());
  for (size_t i = 0; i < x.size(); ++i) x[i] = std::ldexp(points[i].x, -scale.pyramid_level);
  for (size_t i = 0; i < y.size(); ++i) y[i] = std::ldexp(points[separable ? i * columns : i].y, -scale.pyramid_level);
  const int period = georeference_->wraps() ? source_.width(scale.pyramid_level) : 0;
  const AxisTaps x_taps = MakeTaps(x, scale.shrink_x, kernel, period);
  const AxisTaps y_taps = MakeTaps(y, scale.shrink_y, kernel, 0);
  if (x_taps.length == 0 || y_taps.length == 0) return std::vector<Number>(points.size() * (channels_ + 1));
  const PixelWindow window = MakeWindow(scale.pyramid_level, x_taps, y_taps, edge);
  return separable ? ResampleGrid<Number>(window, x_taps, y_taps) : ResamplePoints<Number>(window, x_taps, y_taps);
}

// Towards the border of what is valid, the edge of the source included, the weight falls to 0 over feather_m: twice the
// share of a tent that wide which lies on valid pixels, less the half that it has on the border itself.
void SourceSampler::Feather(std::span<const PixelPoint> points, size_t columns, std::span<float> weights) {
  const double feather_deg = source_.spec().feather_m / kMetresPerDegree;
  const Scale scale = ScaleAt((extent().south_deg + extent().north_deg) / 2, feather_deg);
  const std::vector<float> filtered = Filter<float>(points, columns, scale, Kernel::kTent, Edge::kEmpty);
  for (size_t i = 0; i < weights.size(); ++i) {
    weights[i] *= std::clamp(2.0f * filtered[i * (channels_ + 1) + channels_] - 1.0f, 0.0f, 1.0f);
  }
}

template <typename Number>
Samples<Number> SourceSampler::Sample(const LatticeRows& lattice, double spacing_deg) {
  const size_t columns = lattice.longitudes_deg.size();
  const size_t all_rows = lattice.latitudes_deg.size();
  Samples<Number> samples;
  samples.channels = channels_;
  samples.values.resize(columns * all_rows * channels_);
  samples.weights.resize(columns * all_rows);
  const bool heights = kind_ == LayerKind::kElevation;
  for (size_t row = 0; row < all_rows;) {
    // Rows of one scale go together; a separable source has only one.
    const Scale scale = ScaleAt(lattice.latitudes_deg[row], spacing_deg);
    size_t end = row + 1;
    while (end < all_rows && (georeference_->separable() || ScaleAt(lattice.latitudes_deg[end], spacing_deg) == scale))
      ++end;
    const std::vector<PixelPoint> points = PixelsOf(lattice, row, end - row);
    const Kernel kernel = heights ? Kernel::kTent : Kernel::kCubic;
    const std::vector<Number> filtered = Filter<Number>(points, columns, scale, kernel, Edge::kRepeat);
    const size_t base = row * columns;
    for (size_t i = 0; i < points.size(); ++i) {
      const Number* in = &filtered[i * (channels_ + 1)];
      const auto coverage = static_cast<float>(in[channels_]);
      if (std::isnan(points[i].x) || std::isnan(points[i].y) || coverage <= 0 || (heights && coverage < kLeastCoverage))
        continue;
      for (size_t c = 0; c < channels_; ++c) samples.values[(base + i) * channels_ + c] = in[c] / in[channels_];
      samples.weights[base + i] = heights ? 1.0f : std::min(1.0f, coverage);
    }
    if (source_.spec().feather_m > 0) {
      Feather(points, columns, {&samples.weights[base], points.size()});
    }
    row = end;
  }
  return samples;
}

template Samples<float> SourceSampler::Sample<float>(const LatticeRows&, double);
template Samples<double> SourceSampler::Sample<double>(const LatticeRows&, double);

}  // namespace belvedere

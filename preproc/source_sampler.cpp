#include "preproc/source_sampler.h"

#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostUneven = 8;         // between positions, pixels one way over those the other way, at most
constexpr double kWidestShrink = 64;      // pixels of a pyramid level between positions, at most
constexpr float kLeastCoverage = 0.499f;  // of a height, for it to count; half a pixel's worth
constexpr float kWhole = 0.9995f;         // a coverage that only rounding keeps from 1

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
      georeference_(source.georeference().Clone()) {
  if (source.spec().feather_m > 0) PrepareFeather();
}

// Pixels between positions, measured at the source's middle longitude, and the pyramid level to take them from.
SourceSampler::Scale SourceSampler::ScaleAt(double latitude_deg, const Spacing& spacing) {
  const GeoBox& box = extent();
  const double margin = 0.02 * (box.north_deg - box.south_deg);
  const double lat = std::clamp(latitude_deg, box.south_deg + margin, box.north_deg - margin);
  const double lon = (box.west_deg + box.east_deg) / 2;
  const double step = georeference_->spacing_deg() / 2;
  const PixelPoint here = georeference_->ToPixel(lon, lat);
  const PixelPoint east = georeference_->ToPixel(lon + step, lat);
  const PixelPoint north = georeference_->ToPixel(lon, lat + (lat + step > 90 ? -step : step));
  const double steps_east = spacing.east_deg / step, steps_north = spacing.north_deg / step;
  double x = std::max(std::abs(east.x - here.x) * steps_east, std::abs(north.x - here.x) * steps_north);
  double y = std::max(std::abs(east.y - here.y) * steps_east, std::abs(north.y - here.y) * steps_north);
  if (!std::isfinite(x) || !std::isfinite(y)) x = y = spacing.north_deg / georeference_->spacing_deg();
  // Close to a pole a source's pixels may crowd along parallels, and say the same.
  const double most = kMostUneven * std::min(x, y);
  x = std::min(x, most);
  y = std::min(y, most);
  Scale scale;
  const double least = std::min(x, y);
  if (least >= 2) scale.pyramid_level = std::min(static_cast<int>(std::log2(least)), source_.pyramid_levels());
  scale.shrink_x = Rounded(std::ldexp(x, -scale.pyramid_level));
  scale.shrink_y = Rounded(std::ldexp(y, -scale.pyramid_level));
  return scale;
}

SourceSampler::Positions SourceSampler::PositionsOf(const LatticeRows& lattice, size_t first_row, size_t rows) {
  const size_t columns = lattice.longitudes_deg.size();
  const int width = source_.width(0);
  const int height = source_.height(0);
  Positions positions;
  if (georeference_->separable()) {
    for (const double longitude : lattice.longitudes_deg) {
      positions.x.push_back(OnAxis(georeference_->ToPixel(longitude, lattice.latitudes_deg[first_row]).x, width));
    }
    for (size_t j = first_row; j < first_row + rows; ++j) {
      positions.y.push_back(
          OnAxis(georeference_->ToPixel(lattice.longitudes_deg[0], lattice.latitudes_deg[j]).y, height));
    }
    return positions;
  }
  // What the extent, which is never too small, leaves out is spared the projection.
  std::vector<double> longitudes, latitudes;
  std::vector<size_t> places;
  for (size_t j = first_row; j < first_row + rows; ++j) {
    for (size_t i = 0; i < columns; ++i) {
      if (!Covers(extent(), lattice.longitudes_deg[i], lattice.latitudes_deg[j])) continue;
      longitudes.push_back(lattice.longitudes_deg[i]);
      latitudes.push_back(lattice.latitudes_deg[j]);
      places.push_back((j - first_row) * columns + i);
    }
  }
  std::vector<PixelPoint> points(places.size());
  georeference_->ToPixels(longitudes, latitudes, points);
  positions.x.assign(columns * rows, kNaN);
  positions.y.assign(columns * rows, kNaN);
  for (size_t i = 0; i < points.size(); ++i) {
    const double x = OnAxis(points[i].x, width), y = OnAxis(points[i].y, height);
    if (std::isnan(x) || std::isnan(y)) continue;
    positions.x[places[i]] = x;
    positions.y[places[i]] = y;
  }
  return positions;
}

std::vector<double> SourceSampler::AxisAtLevel(std::vector<double> axis, int pyramid_level) {
  for (double& position : axis) position = std::ldexp(position, -pyramid_level);
  return axis;
}

bool SourceSampler::IsOnSource(const Positions& positions, size_t columns, size_t i) const {
  const bool separable = georeference_->separable();
  return !std::isnan(positions.x[separable ? i % columns : i]) && !std::isnan(positions.y[separable ? i / columns : i]);
}

void SourceSampler::CopyPixels(const Block& block, size_t at, size_t count, Plane plane, float* out) const {
  const bool has_heights = plane == Plane::kPixels && kind_ == LayerKind::kElevation;
  const bool has_colours = plane == Plane::kPixels && !has_heights;
  for (size_t i = at; i < at + count; ++i, out += channels_ + 1) {
    const float coverage = static_cast<float>(block.coverage[i]) / 255.0f;
    if (has_heights) out[0] = block.heights[i] * coverage;
    for (size_t c = 0; has_colours && c < 3; ++c) out[c] = static_cast<float>(block.colours[3 * i + c]) * coverage;
    out[channels_] = coverage;
  }
}

PixelWindow SourceSampler::MakeWindow(int pyramid_level, const AxisTaps& x, const AxisTaps& y, Plane plane) const {
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
    for (int i = 0; i < window.width;) {
      const int wanted = window.x + i;
      const int column = wraps ? ((wanted % width) + width) % width : std::clamp(wanted, 0, width - 1);
      if (column / kBlockSide != block_column || row / kBlockSide != block_row) {
        block_column = column / kBlockSide;
        block_row = row / kBlockSide;
        block = plane == Plane::kPixels ? source_.GetBlock(pyramid_level, block_column, block_row)
                                        : source_.GetDomain(pyramid_level, block_column, block_row);
      }
      // As many of the row as lie side by side in the block.
      const bool is_beside = wraps || (wanted >= 0 && wanted < width);
      const int there = std::min(kBlockSide - column % kBlockSide, width - column);
      const int run = is_beside ? std::min(there, window.width - i) : 1;
      const auto at = static_cast<size_t>(row % kBlockSide * kBlockSide + column % kBlockSide);
      CopyPixels(*block, at, static_cast<size_t>(run), plane, out);
      out += static_cast<size_t>(run) * size;
      i += run;
    }
  }
  return window;
}

template <typename Number>
std::vector<Number> SourceSampler::Filter(const Positions& positions, const Scale& scale, Kernel kernel,
                                          Plane plane) const {
  const bool separable = georeference_->separable();
  const int period = georeference_->wraps() ? source_.width(scale.pyramid_level) : 0;
  const AxisTaps x = MakeTaps(AxisAtLevel(positions.x, scale.pyramid_level), scale.shrink_x, kernel, period);
  const AxisTaps y = MakeTaps(AxisAtLevel(positions.y, scale.pyramid_level), scale.shrink_y, kernel, 0);
  if (x.length == 0 || y.length == 0) {
    const size_t count = separable ? positions.x.size() * positions.y.size() : positions.x.size();
    return std::vector<Number>(count * (channels_ + 1));
  }
  const PixelWindow window = MakeWindow(scale.pyramid_level, x, y, plane);
  std::vector<Number> filtered = separable ? ResampleGrid<Number>(window, x, y) : ResamplePoints<Number>(window, x, y);
  if (kind_ == LayerKind::kElevation && kernel == Kernel::kCubic) ClampToNearest(window, x, y, separable, filtered);
  return filtered;
}

// A cubic where all its pixels have heights, bilinear where some have none; averages where the source is finer.
template <typename Number>
std::vector<Number> SourceSampler::FilterHeights(const Positions& positions, const Scale& scale) const {
  if (scale.shrink_x > 1 || scale.shrink_y > 1) return Filter<Number>(positions, scale, Kernel::kTent, Plane::kPixels);
  std::vector<Number> heights = Filter<Number>(positions, scale, Kernel::kCubic, Plane::kPixels);
  const auto is_whole = [&](size_t at) {
    const auto coverage = static_cast<float>(heights[at + 1]);
    return coverage == 0 || std::abs(1 - coverage) < 1 - kWhole;
  };
  std::vector<Number> bilinear;
  for (size_t at = 0; at < heights.size(); at += 2) {
    if (is_whole(at)) continue;
    if (bilinear.empty()) bilinear = Filter<Number>(positions, scale, Kernel::kTent, Plane::kPixels);
    heights[at] = bilinear[at];
    heights[at + 1] = bilinear[at + 1];
  }
  return heights;
}

void SourceSampler::FindVoids(const Positions& positions, const Scale& scale, std::span<const float> weights,
                              std::span<float> void_weights) const {
  const std::vector<float> domain = Filter<float>(positions, scale, Kernel::kTent, Plane::kDomain);
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0 && domain[2 * i + 1] >= kLeastCoverage) void_weights[i] = 1.0f;
  }
}

template <typename Number>
Samples<Number> SourceSampler::Sample(const LatticeRows& lattice, const Spacing& spacing, bool feathered) {
  const size_t columns = lattice.longitudes_deg.size();
  const size_t all_rows = lattice.latitudes_deg.size();
  Samples<Number> samples;
  samples.channels = channels_;
  samples.values.resize(columns * all_rows * channels_);
  samples.weights.resize(columns * all_rows);
  const bool heights = kind_ == LayerKind::kElevation;
  const float least_coverage = heights ? kLeastCoverage : 1e-6f;
  for (size_t row = 0, end = 0; row < all_rows; row = end) {
    end = row + 1;
    if (lattice.latitudes_deg[row] < extent().south_deg || lattice.latitudes_deg[row] > extent().north_deg) continue;
    // Rows of one scale go together; a separable source has only one.
    const Scale scale = ScaleAt(lattice.latitudes_deg[row], spacing);
    while (end < all_rows && (georeference_->separable() || ScaleAt(lattice.latitudes_deg[end], spacing) == scale))
      ++end;
    const Positions positions = PositionsOf(lattice, row, end - row);
    const std::vector<Number> filtered = heights ? FilterHeights<Number>(positions, scale)
                                                 : Filter<Number>(positions, scale, Kernel::kCubic, Plane::kPixels);
    const size_t base = row * columns;
    const size_t count = (end - row) * columns;
    bool missing = false;
    for (size_t i = 0; i < count; ++i) {
      // Positions off the source have no coverage.
      const Number* in = &filtered[i * (channels_ + 1)];
      const auto coverage = static_cast<float>(in[channels_]);
      if (coverage < least_coverage) {
        missing = missing || (heights && IsOnSource(positions, columns, i));
        continue;
      }
      for (size_t c = 0; c < channels_; ++c) samples.values[(base + i) * channels_ + c] = in[c] / in[channels_];
      samples.weights[base + i] = heights || coverage > kWhole ? 1.0f : coverage;
    }
    if (missing && source_.HasVoids()) {
      samples.void_weights.resize(samples.weights.size());
      FindVoids(positions, scale, {&samples.weights[base], count}, {&samples.void_weights[base], count});
    }
    if (!feathered || source_.spec().feather_m <= 0) continue;
    const std::vector<float> feather = FeatherOf(lattice, row, end - row, positions, scale);
    for (size_t i = 0; i < count; ++i) {
      samples.weights[base + i] *= feather[i];
      if (!samples.void_weights.empty()) samples.void_weights[base + i] *= feather[i];
    }
  }
  return samples;
}

template Samples<float> SourceSampler::Sample<float>(const LatticeRows&, const Spacing&, bool);
template Samples<double> SourceSampler::Sample<double>(const LatticeRows&, const Spacing&, bool);

}  // namespace belvedere

#include "preproc/source_sampler.h"

#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kWidestShrink = 64;       // pixels of a pyramid level between positions, at most
constexpr float kLeastCoverage = 0.499f;   // of a height, for it to count; half a pixel's worth
constexpr float kWhole = 0.9995f;          // a coverage that only rounding keeps from 1
constexpr double kMostFeatherPixels = 48;  // over which a feather reaches, at the pyramid level where it is measured
constexpr int kMostFeatherColumns = 2048;  // near a pole, where columns are narrow
constexpr uint8_t kHalfInside = 128;

// Position on the source, or none.
double OnAxis(double position, int length) {
  return position >= 0 && position <= length ? position : kNaN;
}

// Quarter octaves, so that rows of nearly one scale are filtered together; all enlarging is one.
double Rounded(double shrink) {
  return shrink <= 1 ? 1.0 : std::min(std::exp2(std::ceil(4 * std::log2(shrink) - 1e-6) / 4), kWidestShrink);
}

std::vector<double> AtLevel(std::vector<double> axis, int pyramid_level) {
  for (double& position : axis) position = std::ldexp(position, -pyramid_level);
  return axis;
}

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

SourceSampler::SourceSampler(RasterSource& source, LayerKind kind)
    : source_(source),
      kind_(kind),
      channels_(kind == LayerKind::kElevation ? 1 : 3),
      georeference_(source.georeference().Clone()) {
  if (source.spec().feather_m <= 0) return;
  feather_level_ = FeatherLevel();
  if (!georeference_->wraps()) return;
  for (const double pole_deg : {-90.0, 90.0}) {
    const double y = georeference_->ToPixel(extent().west_deg, pole_deg).y;
    first_row_is_pole_ |= std::abs(y) <= 1;
    last_row_is_pole_ |= std::abs(y - source.height(0)) <= 1;
  }
}

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

PixelWindow SourceSampler::MakeWindow(int pyramid_level, const AxisTaps& x, const AxisTaps& y) const {
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
std::vector<Number> SourceSampler::Filter(const Positions& positions, const Scale& scale, Kernel kernel) const {
  const bool separable = georeference_->separable();
  const int period = georeference_->wraps() ? source_.width(scale.pyramid_level) : 0;
  const AxisTaps x = MakeTaps(AtLevel(positions.x, scale.pyramid_level), scale.shrink_x, kernel, period);
  const AxisTaps y = MakeTaps(AtLevel(positions.y, scale.pyramid_level), scale.shrink_y, kernel, 0);
  if (x.length == 0 || y.length == 0) {
    const size_t count = separable ? positions.x.size() * positions.y.size() : positions.x.size();
    return std::vector<Number>(count * (channels_ + 1));
  }
  const PixelWindow window = MakeWindow(scale.pyramid_level, x, y);
  return separable ? ResampleGrid<Number>(window, x, y) : ResamplePoints<Number>(window, x, y);
}

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
  // Radii of curvature along the parallel and the meridian.
  const double sine = std::sin(lat * kRadiansPerDegree);
  const double flattened = 1 - kEccentricitySquared * sine * sine;
  const double normal_m = kEquatorialRadius_m / std::sqrt(flattened);
  const double meridian_m = normal_m * (1 - kEccentricitySquared) / flattened;
  const double east_m = step * kRadiansPerDegree * normal_m * std::cos(lat * kRadiansPerDegree);
  const double north_m = north_step * kRadiansPerDegree * meridian_m;
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
  // Where a feather is a few pixels wide a gap in one is not to hide the whole pixel.
  const uint8_t least = pyramid_level <= feather_level_ ? 255 : kHalfInside;
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
      *out = block->coverage[static_cast<size_t>(row % kBlockSide * kBlockSide + column % kBlockSide)] >= least;
    }
  }
  return window;
}

void SourceSampler::ApplyFeather(const LatticeRows& lattice, size_t first_row, size_t rows, const Positions& positions,
                                 const Scale& scale, std::span<float> weights) {
  const int level = std::max(feather_level_, scale.pyramid_level);
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
  const Positions at_level{AtLevel(positions.x, level), AtLevel(positions.y, level)};
  DomainWindow window = MakeDomainWindow(level, at_level, margin(least.x_m), margin(least.y_m));
  if (window.inside.empty()) return;
  const Feather feather(std::move(window));
  if (feather.whole()) return;
  const bool separable = georeference_->separable();
  const size_t columns = weights.size() / rows;
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0) continue;
    const double x = at_level.x[separable ? i % columns : i], y = at_level.y[separable ? i / columns : i];
    weights[i] *= feather.WeightAt(x, y, sizes[i / columns], feather_m);
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
  const float least_coverage = heights ? kLeastCoverage : 1e-6f;
  for (size_t row = 0, end = 0; row < all_rows; row = end) {
    end = row + 1;
    if (lattice.latitudes_deg[row] < extent().south_deg || lattice.latitudes_deg[row] > extent().north_deg) continue;
    // Rows of one scale go together; a separable source has only one.
    const Scale scale = ScaleAt(lattice.latitudes_deg[row], spacing_deg);
    while (end < all_rows && (georeference_->separable() || ScaleAt(lattice.latitudes_deg[end], spacing_deg) == scale))
      ++end;
    const Positions positions = PositionsOf(lattice, row, end - row);
    const auto filtered = Filter<Number>(positions, scale, heights ? Kernel::kTent : Kernel::kCubic);
    const size_t base = row * columns;
    const size_t count = (end - row) * columns;
    for (size_t i = 0; i < count; ++i) {
      // Positions off the source have no coverage.
      const Number* in = &filtered[i * (channels_ + 1)];
      const auto coverage = static_cast<float>(in[channels_]);
      if (coverage < least_coverage) continue;
      for (size_t c = 0; c < channels_; ++c) samples.values[(base + i) * channels_ + c] = in[c] / in[channels_];
      samples.weights[base + i] = heights || coverage > kWhole ? 1.0f : coverage;
    }
    if (source_.spec().feather_m > 0)
      ApplyFeather(lattice, row, end - row, positions, scale, {&samples.weights[base], count});
  }
  return samples;
}

template Samples<float> SourceSampler::Sample<float>(const LatticeRows&, double);
template Samples<double> SourceSampler::Sample<double>(const LatticeRows&, double);

}  // namespace belvedere

#include "preproc/resample.h"

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

double Weight(double distance, Kernel kernel) {
  const double d = std::abs(distance);
  if (kernel == Kernel::kTent) return std::max(0.0, 1.0 - d);
  if (d < 1) return 1.0 + d * d * (1.5 * d - 2.5);
  if (d < 2) return 2.0 + d * (-4.0 + d * (2.5 - 0.5 * d));
  return 0;
}

void FillTaps(AxisTaps& taps, size_t i, double position, double shrink, Kernel kernel) {
  const double radius = KernelRadius(shrink, kernel);
  const double widened = std::max(1.0, shrink);
  const double centre = position - 0.5;
  const auto first = static_cast<int>(std::floor(centre - radius)) + 1;
  const auto last = static_cast<int>(std::ceil(centre + radius)) - 1;
  taps.first[i] = first;
  taps.count[i] = last - first + 1;
  double sum = 0;
  double* weights = &taps.weights[i * taps.stride];
  for (int j = first; j <= last; ++j) sum += weights[j - first] = Weight((j - centre) / widened, kernel);
  for (int j = first; j <= last; ++j) weights[j - first] /= sum;
}

}  // namespace

double KernelRadius(double shrink, Kernel kernel) {
  return (kernel == Kernel::kTent ? 1.0 : 2.0) * std::max(1.0, shrink);
}

AxisTaps MakeTaps(std::span<const double> positions, double shrink, Kernel kernel, int period) {
  AxisTaps taps;
  taps.first.assign(positions.size(), 0);
  taps.count.assign(positions.size(), 0);
  taps.stride = static_cast<size_t>(2 * std::ceil(KernelRadius(shrink, kernel))) + 1;
  taps.weights.assign(positions.size() * taps.stride, 0.0);
  bool any = false;
  int highest = 0, before = 0;
  for (size_t i = 0; i < positions.size(); ++i) {
    if (!std::isfinite(positions[i])) continue;
    FillTaps(taps, i, positions[i], shrink, kernel);
    int& first = taps.first[i];
    if (any && period > 0) {
      first += period * static_cast<int>(std::lround(static_cast<double>(before - first) / period));
    }
    before = first;
    taps.lowest = any ? std::min(taps.lowest, first) : first;
    highest = any ? std::max(highest, first + taps.count[i]) : first + taps.count[i];
    any = true;
  }
  taps.length = any ? highest - taps.lowest : 0;
  return taps;
}

namespace {

// kSize numbers a pixel, coverage included: known here so that the sums stay in registers.
template <typename Number, size_t kSize>
std::vector<Number> Grid(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y) {
  const size_t columns = x.first.size();
  const size_t line = columns * kSize;
  const std::vector<Number> weights(x.weights.begin(), x.weights.end());
  // Along the rows first, those that some position needs.
  std::vector<Number> narrowed(static_cast<size_t>(y.length) * line);
  for (int row = 0; row < y.length; ++row) {
    const auto in_row = static_cast<size_t>(y.lowest + row - window.y) * static_cast<size_t>(window.width);
    Number* out = &narrowed[static_cast<size_t>(row) * line];
    for (size_t i = 0; i < columns; ++i, out += kSize) {
      if (x.count[i] == 0) continue;
      const float* in = &window.pixels[(in_row + static_cast<size_t>(x.first[i] - window.x)) * kSize];
      const Number* weight = &weights[i * x.stride];
      Number sums[kSize] = {};
      for (int tap = 0; tap < x.count[i]; ++tap, in += kSize) {
        for (size_t c = 0; c < kSize; ++c) sums[c] += weight[tap] * static_cast<Number>(in[c]);
      }
      for (size_t c = 0; c < kSize; ++c) out[c] = sums[c];
    }
  }
  std::vector<Number> result(y.first.size() * line);
  for (size_t j = 0; j < y.first.size(); ++j) {
    Number* out = &result[j * line];
    for (int tap = 0; tap < y.count[j]; ++tap) {
      const auto weight = static_cast<Number>(y.weights[j * y.stride + static_cast<size_t>(tap)]);
      const Number* in = &narrowed[static_cast<size_t>(y.first[j] + tap - y.lowest) * line];
      for (size_t i = 0; i < line; ++i) out[i] += weight * in[i];
    }
  }
  return result;
}

template <typename Number, size_t kSize>
std::vector<Number> Points(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y) {
  std::vector<Number> result(x.first.size() * kSize);
  for (size_t i = 0; i < x.first.size(); ++i) {
    if (x.count[i] == 0) continue;
    Number sums[kSize] = {};
    for (int j = 0; j < y.count[i]; ++j) {
      const auto row = static_cast<size_t>(y.first[i] + j - window.y) * static_cast<size_t>(window.width);
      const float* in = &window.pixels[(row + static_cast<size_t>(x.first[i] - window.x)) * kSize];
      const double row_weight = y.weights[i * y.stride + static_cast<size_t>(j)];
      for (int tap = 0; tap < x.count[i]; ++tap, in += kSize) {
        const auto weight = static_cast<Number>(row_weight * x.weights[i * x.stride + static_cast<size_t>(tap)]);
        for (size_t c = 0; c < kSize; ++c) sums[c] += weight * static_cast<Number>(in[c]);
      }
    }
    std::copy_n(sums, kSize, &result[i * kSize]);
  }
  return result;
}

}  // namespace

template <typename Number>
std::vector<Number> ResampleGrid(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y) {
  return window.channels == 1 ? Grid<Number, 2>(window, x, y) : Grid<Number, 4>(window, x, y);
}

template <typename Number>
std::vector<Number> ResamplePoints(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y) {
  return window.channels == 1 ? Points<Number, 2>(window, x, y) : Points<Number, 4>(window, x, y);
}

template <typename Number>
void ClampToNearest(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y, bool grid,
                    std::vector<Number>& values) {
  constexpr size_t kSize = 2;  // the height and its coverage
  // The taps begin one before the pixels next to the position.
  const auto pixel_at = [&](size_t i, size_t j) {
    const auto row = static_cast<size_t>(y.first[j] + 1 - window.y) * static_cast<size_t>(window.width);
    return &window.pixels[(row + static_cast<size_t>(x.first[i] + 1 - window.x)) * kSize];
  };
  const auto to_north = [&](size_t j) { return y.count[j] > 3 ? static_cast<size_t>(window.width) * kSize : 0; };
  const auto clamp = [&](size_t i, const float* south, const float* north, Number& value) {
    const size_t east = x.count[i] > 3 ? kSize : 0;
    const float low = std::min(std::min(south[0], south[east]), std::min(north[0], north[east]));
    const float high = std::max(std::max(south[0], south[east]), std::max(north[0], north[east]));
    value = std::min(std::max(value, static_cast<Number>(low)), static_cast<Number>(high));
  };
  if (!grid) {
    for (size_t i = 0; i < x.first.size(); ++i) {
      if (x.count[i] == 0 || y.count[i] == 0) continue;
      const float* south = pixel_at(i, i);
      clamp(i, south, south + to_north(i), values[i * kSize]);
    }
    return;
  }
  for (size_t j = 0; j < y.first.size(); ++j) {
    if (y.count[j] == 0) continue;
    const size_t north = to_north(j);
    Number* value = &values[j * x.first.size() * kSize];
    for (size_t i = 0; i < x.first.size(); ++i, value += kSize) {
      if (x.count[i] == 0) continue;
      const float* south = pixel_at(i, j);
      clamp(i, south, south + north, *value);
    }
  }
}

template void ClampToNearest<float>(const PixelWindow&, const AxisTaps&, const AxisTaps&, bool, std::vector<float>&);
template void ClampToNearest<double>(const PixelWindow&, const AxisTaps&, const AxisTaps&, bool, std::vector<double>&);
template std::vector<float> ResampleGrid<float>(const PixelWindow&, const AxisTaps&, const AxisTaps&);
template std::vector<double> ResampleGrid<double>(const PixelWindow&, const AxisTaps&, const AxisTaps&);
template std::vector<float> ResamplePoints<float>(const PixelWindow&, const AxisTaps&, const AxisTaps&);
template std::vector<double> ResamplePoints<double>(const PixelWindow&, const AxisTaps&, const AxisTaps&);

}  // namespace belvedere

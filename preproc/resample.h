// Resampling: weighted sums of a window of pixels, one for each wanted position.
//
// When a source is enlarged a tent of one pixel is bilinear interpolation, and the cubic is Catmull and Rom's (1974),
// which passes through the pixels and has no corners; when it is shrunk both are widened by the shrinking factor, so
// that what is finer than the result averages out. The weights of a position depend on its pixel coordinates alone.
//
// A window's pixels are interleaved: the channels multiplied by coverage, then the coverage, 0 to 1.
//
// Threads: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace belvedere {

enum class Kernel { kTent, kCubic };

// The pixels of one axis that count for each position: weights[i * stride ..] for pixels first[i] .. first[i] +
// count[i]. A position without a source has count 0.
struct AxisTaps {
  std::vector<int> first, count;
  std::vector<double> weights;  // of each position they add up to 1
  size_t stride = 0;
  // Range of pixels over all positions: [lowest, lowest + length); length 0 when there is none.
  int lowest = 0, length = 0;
};

// positions: continuous pixel coordinates (0.5 is the centre of pixel 0), NaN for none. shrink: source pixels between
// positions. period: 0, or the number of pixels after which the axis closes on itself; pixel numbers then run on past
// it, so that neighbouring positions have neighbouring numbers.
AxisTaps MakeTaps(std::span<const double> positions, double shrink, Kernel kernel, int period);
double KernelRadius(double shrink, Kernel kernel);

struct PixelWindow {
  int x = 0, y = 0, width = 0, height = 0;
  size_t channels = 1;  // without the coverage: 1 or 3
  std::vector<float> pixels;
};

// Every column of x with every row of y: y.first.size() rows of x.first.size() times channels + 1 numbers.
// REQUIRES: the window holds all that the taps name.
template <typename Number>
std::vector<Number> ResampleGrid(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y);

// Position i with x's and y's taps i.
template <typename Number>
std::vector<Number> ResamplePoints(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y);

// Of heights that a cubic that is not widened has made: keeps each between the lowest and the highest of the four
// pixels around its position, so that it does not swing over at cliffs and shores. grid: as of ResampleGrid, else of
// ResamplePoints.
template <typename Number>
void ClampToNearest(const PixelWindow& window, const AxisTaps& x, const AxisTaps& y, bool grid,
                    std::vector<Number>& values);

}  // namespace belvedere

#include "preproc/resample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace belvedere {
namespace {

PixelWindow MakeWindow(const AxisTaps& x, const AxisTaps& y, const std::function<double(int, int)>& value) {
  PixelWindow window{x.lowest, y.lowest, x.length, y.length, 1, {}};
  for (int row = 0; row < y.length; ++row) {
    for (int column = 0; column < x.length; ++column) {
      window.pixels.push_back(static_cast<float>(value(x.lowest + column, y.lowest + row)));
      window.pixels.push_back(1.0f);
    }
  }
  return window;
}

std::vector<double> Positions(double first, double step, size_t count) {
  std::vector<double> positions;
  for (size_t i = 0; i < count; ++i) positions.push_back(first + step * static_cast<double>(i));
  return positions;
}

TEST(Resample, ARampStaysARampAtEveryScale) {
  const auto ramp = [](int column, int row) { return 3.0 * column - 2.0 * row; };
  for (const Kernel kernel : {Kernel::kTent, Kernel::kCubic}) {
    for (const double step : {0.13, 0.5, 1.0}) {
      const auto x = MakeTaps(Positions(20.3, step, 40), step, kernel, 0);
      const auto y = MakeTaps(Positions(31.7, step, 30), step, kernel, 0);
      const auto out = ResampleGrid<double>(MakeWindow(x, y, ramp), x, y);
      for (size_t j = 0; j < 30; ++j) {
        for (size_t i = 0; i < 40; ++i) {
          const double wanted =
              3.0 * (19.8 + step * static_cast<double>(i)) - 2.0 * (31.2 + step * static_cast<double>(j));
          EXPECT_NEAR(out[2 * (40 * j + i)], wanted, 1e-5) << step;
          EXPECT_NEAR(out[2 * (40 * j + i) + 1], 1.0, 1e-6);
        }
      }
    }
  }
}

TEST(Resample, ACheckerboardFinerThanTheResultAveragesOut) {
  const auto board = [](int column, int row) { return (column + row) % 2 == 0 ? 100.0 : 0.0; };
  for (const Kernel kernel : {Kernel::kTent, Kernel::kCubic}) {
    for (const double step : {2.0, 3.7}) {
      const auto x = MakeTaps(Positions(50.1, step, 20), step, kernel, 0);
      const auto out = ResampleGrid<double>(MakeWindow(x, x, board), x, x);
      for (size_t i = 0; i < 400; ++i) EXPECT_NEAR(out[2 * i], 50.0, 2.0) << step;
    }
  }
}

TEST(Resample, PixelCentresKeepTheirValue) {
  const auto noise = [](int column, int row) { return (column * 7919 + row * 104729) % 255; };
  for (const Kernel kernel : {Kernel::kTent, Kernel::kCubic}) {
    const auto x = MakeTaps(Positions(10.5, 1.0, 12), 1.0, kernel, 0);
    const auto out = ResampleGrid<double>(MakeWindow(x, x, noise), x, x);
    for (int row = 0; row < 12; ++row) {
      for (int column = 0; column < 12; ++column) {
        EXPECT_NEAR(out[static_cast<size_t>(2 * (12 * row + column))], noise(10 + column, 10 + row), 1e-9);
      }
    }
  }
}

TEST(Resample, PointsAndGridAgree) {
  const auto noise = [](int column, int row) { return (column * 31 + row * 17) % 101; };
  const auto x = MakeTaps(Positions(10.2, 1.7, 9), 1.7, Kernel::kTent, 0);
  const auto y = MakeTaps(Positions(14.9, 1.3, 9), 1.3, Kernel::kTent, 0);
  const auto window = MakeWindow(x, y, noise);
  const auto grid = ResampleGrid<double>(window, x, y);
  const auto points = ResamplePoints<double>(window, x, y);
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(points[2 * i], grid[2 * (9 * i + i)], 1e-9);
}

TEST(Resample, AnAxisThatClosesRunsOnPastItsEnd) {
  const std::vector<double> positions = {358.6, 359.6, 0.6, 1.6};
  const auto taps = MakeTaps(positions, 1.0, Kernel::kTent, 360);
  EXPECT_EQ(taps.first, (std::vector<int>{358, 359, 360, 361}));
  EXPECT_LE(taps.length, 6);
  // The weights are those of the position itself, whoever stands beside it.
  const auto alone = MakeTaps(std::vector<double>{0.6}, 1.0, Kernel::kTent, 360);
  for (size_t i = 0; i < taps.stride; ++i) EXPECT_EQ(alone.weights[i], taps.weights[2 * taps.stride + i]);
}

TEST(Resample, PositionsWithoutASourceCountNothing) {
  const std::vector<double> nowhere = {std::numeric_limits<double>::quiet_NaN(), 5.5};
  const auto taps = MakeTaps(nowhere, 1.0, Kernel::kTent, 0);
  EXPECT_EQ(taps.count[0], 0);
  const auto out = ResampleGrid<double>(MakeWindow(taps, taps, [](int, int) { return 9.0; }), taps, taps);
  EXPECT_EQ(out[1], 0.0);
  EXPECT_NEAR(out[7], 1.0, 1e-12);
}

// A cliff of 100 m between columns 4 and 5, and pixels of one coverage.
PixelWindow Cliff() {
  PixelWindow window{0, 0, 10, 10, 1, {}};
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      window.pixels.push_back(column < 5 ? 0.0F : 100.0F);
      window.pixels.push_back(1.0F);
    }
  }
  return window;
}

TEST(Resample, AClampedCubicStaysBetweenThePixelsNextToIt) {
  const PixelWindow window = Cliff();
  const std::vector<double> along = {3.5, 3.9, 4.4, 5.0, 5.6, 6.2, 6.5};
  const AxisTaps taps = MakeTaps(along, 1.0, Kernel::kCubic, 0);
  for (const bool grid : {true, false}) {
    auto heights = grid ? ResampleGrid<double>(window, taps, taps) : ResamplePoints<double>(window, taps, taps);
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    EXPECT_LT(*low, -1) << "a cubic swings over at a cliff";
    EXPECT_GT(*high, 101);
    ClampToNearest(window, taps, taps, grid, heights);
    const size_t rows = grid ? along.size() : 1;
    for (size_t row = 0; row < rows; ++row) {
      const auto at = [&](size_t i) { return heights[(row * along.size() + i) * 2]; };
      for (size_t west = 0; west < 3; ++west) EXPECT_EQ(at(west), 0) << west;
      EXPECT_NEAR(at(3), 50, 1e-9);
      EXPECT_EQ(at(5), 100);
      EXPECT_EQ(at(6), 100);
    }
  }
}

TEST(Resample, AClampedCubicKeepsPixelsAndWhatLiesBetweenThem) {
  PixelWindow window{0, 0, 8, 8, 1, {}};
  for (int i = 0; i < 64; ++i) {
    window.pixels.push_back(static_cast<float>(i % 8 * i % 13 + i / 8 * 3));
    window.pixels.push_back(1.0F);
  }
  const std::vector<double> along = {2.5, 3.5, 3.75, 4.25, 4.5, 5.5};
  const AxisTaps taps = MakeTaps(along, 1.0, Kernel::kCubic, 0);
  auto heights = ResampleGrid<double>(window, taps, taps);
  ClampToNearest(window, taps, taps, true, heights);
  for (size_t row = 0; row < along.size(); ++row) {
    for (size_t column = 0; column < along.size(); ++column) {
      const double height = heights[(row * along.size() + column) * 2];
      const auto pixel = [&](double x, double y) {
        return window.pixels[(static_cast<size_t>(y) * 8 + static_cast<size_t>(x)) * 2];
      };
      const double x = along[column] - 0.5, y = along[row] - 0.5;
      const auto [low, high] = std::minmax({pixel(std::floor(x), std::floor(y)), pixel(std::ceil(x), std::floor(y)),
                                            pixel(std::floor(x), std::ceil(y)), pixel(std::ceil(x), std::ceil(y))});
      EXPECT_GE(height, low);
      EXPECT_LE(height, high);
      if (x == std::floor(x) && y == std::floor(y)) {
        EXPECT_EQ(height, pixel(x, y));
      }
    }
  }
}

}  // namespace
}  // namespace belvedere

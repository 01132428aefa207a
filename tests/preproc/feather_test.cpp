#include "preproc/feather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace belvedere {
namespace {

// One pixel in `gaps` is not inside.
DomainWindow RandomWindow(int width, int height, unsigned gaps) {
  std::mt19937 random(7);
  DomainWindow window{-11, 23, width, height, std::vector<uint8_t>(static_cast<size_t>(width * height))};
  for (uint8_t& inside : window.inside) inside = random() % gaps != 0 ? 1 : 0;
  return window;
}

// To the nearest of all rectangles that are not inside.
double NearestByTrial(const DomainWindow& window, double x, double y, const PixelSize& size, double most_m) {
  double least = most_m;
  for (int j = 0; j < window.height; ++j) {
    for (int i = 0; i < window.width; ++i) {
      if (window.inside[static_cast<size_t>(j * window.width + i)] != 0) continue;
      const double left = window.x + i, top = window.y + j;
      const double dx = std::max({left - x, x - left - 1, 0.0}), dy = std::max({top - y, y - top - 1, 0.0});
      least = std::min(least, std::hypot(dx * size.x_m, dy * size.y_m));
    }
  }
  return least;
}

TEST(Feather, TheDistanceIsThatToTheNearestPixelThatIsNotInside) {
  for (const unsigned gaps : {3U, 40U, 700U}) {
    const DomainWindow window = RandomWindow(50, 30, gaps);
    const Feather feather(window);
    ASSERT_FALSE(feather.whole());
    std::mt19937 random(8);
    for (const PixelSize& size : {PixelSize{1, 1}, PixelSize{30, 90}, PixelSize{90, 30}}) {
      for (int trial = 0; trial < 500; ++trial) {
        const double x = window.x + 50.0 * static_cast<double>(random()) / 4294967296.0;
        const double y = window.y + 30.0 * static_cast<double>(random()) / 4294967296.0;
        EXPECT_NEAR(feather.DistanceAt(x, y, size, 1000), NearestByTrial(window, x, y, size, 1000), 1e-9)
            << gaps << " at " << x << " " << y;
      }
    }
  }
}

TEST(Feather, TheWeightRisesFromTheBorderWithoutACorner) {
  DomainWindow window{0, 0, 40, 3, std::vector<uint8_t>(120, 1)};
  for (size_t row = 0; row < 3; ++row) window.inside[40 * row] = 0;
  const Feather feather(window);
  const PixelSize size{10, 10};
  EXPECT_EQ(feather.WeightAt(0.5, 1.5, size, 200), 0.0f) << "not inside";
  EXPECT_EQ(feather.WeightAt(1, 1.5, size, 200), 0.0f) << "on the border";
  EXPECT_NEAR(feather.WeightAt(11, 1.5, size, 200), 0.5f, 1e-6f);
  EXPECT_EQ(feather.WeightAt(21, 1.5, size, 200), 1.0f);
  EXPECT_EQ(feather.WeightAt(39, 1.5, size, 200), 1.0f) << "off the window nothing is missing";
  float before = 0, slope_before = 0;
  for (double x = 1; x < 23; x += 0.1) {
    const float weight = feather.WeightAt(x, 1.5, size, 200);
    const float slope = (weight - before) / 0.1f;
    EXPECT_GE(weight, before);
    EXPECT_NEAR(slope, slope_before, 0.005f) << x;
    before = weight;
    slope_before = slope;
  }
}

TEST(Feather, AWholeWindowCountsAsItIs) {
  const Feather feather(DomainWindow{5, 5, 4, 4, std::vector<uint8_t>(16, 1)});
  EXPECT_TRUE(feather.whole());
  EXPECT_EQ(feather.WeightAt(6, 6, {30, 30}, 1e6), 1.0f);
}

}  // namespace
}  // namespace belvedere

#include "preproc/colour_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

namespace belvedere {
namespace {

// A noise of +-3 on what lies below.
std::vector<ColourPair> MakePairs(int count, const std::function<float(float)>& below) {
  std::mt19937 random(11);
  std::vector<ColourPair> pairs(static_cast<size_t>(count));
  for (ColourPair& pair : pairs) {
    for (size_t c = 0; c < 3; ++c) {
      pair.source[c] = 20.0f + static_cast<float>(random() % 180);
      pair.below[c] = below(pair.source[c]) + static_cast<float>(random() % 7) - 3.0f;
    }
  }
  return pairs;
}

void ExpectFit(const ColourFit& fit, double gain, double offset) {
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(fit.gain[c], gain, 0.02) << c;
    EXPECT_NEAR(fit.offset[c], offset, 2) << c;
  }
}

TEST(ColourFit, FindsGainAndOffsetOfEachChannel) {
  std::vector<ColourPair> pairs = MakePairs(500, [](float value) { return 0.7f * value + 25; });
  for (ColourPair& pair : pairs) pair.below[1] = 1.2f * pair.source[1] - 10;
  const ColourFit fit = FitColours(pairs);
  EXPECT_NEAR(fit.gain[0], 0.7, 0.02);
  EXPECT_NEAR(fit.offset[0], 25, 2);
  EXPECT_NEAR(fit.gain[1], 1.2, 0.001);
  EXPECT_NEAR(fit.offset[1], -10, 0.1);
  EXPECT_NEAR(fit.gain[2], 0.7, 0.02);
}

TEST(ColourFit, CloudsInAQuarterOfThePictureDoNotCount) {
  std::vector<ColourPair> pairs = MakePairs(1000, [](float value) { return 0.7f * value + 25; });
  for (size_t i = 0; i < pairs.size(); i += 4) pairs[i].source = {250, 250, 250};
  ExpectFit(FitColours(pairs), 0.7, 25);
}

TEST(ColourFit, StaysWithinItsLimits) {
  const ColourFit flat = FitColours(MakePairs(500, [](float) { return 90.0f; }));
  const ColourFit steep = FitColours(MakePairs(500, [](float value) { return 5 * value - 400; }));
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_DOUBLE_EQ(flat.gain[c], 1.0 / 3);
    EXPECT_DOUBLE_EQ(steep.gain[c], 3.0);
    EXPECT_GE(steep.offset[c], -128);
  }
}

TEST(ColourFit, OneColourIsShifted) {
  std::vector<ColourPair> pairs(100);
  for (ColourPair& pair : pairs) pair = {{100, 100, 100}, {130, 90, 100}};
  const ColourFit fit = FitColours(pairs);
  EXPECT_EQ(fit.gain, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(fit.offset, (std::array<double, 3>{30, -10, 0}));
  const ColourFit none = FitColours({});
  EXPECT_EQ(none.gain, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(none.offset, (std::array<double, 3>{0, 0, 0}));
}

TEST(ColourFit, TheSameSamplesGiveTheSameFit) {
  const std::vector<ColourPair> pairs = MakePairs(700, [](float value) { return 0.9f * value; });
  EXPECT_EQ(FitColours(pairs).gain, FitColours(pairs).gain);
  EXPECT_EQ(FitColours(pairs).offset, FitColours(pairs).offset);
}

}  // namespace
}  // namespace belvedere

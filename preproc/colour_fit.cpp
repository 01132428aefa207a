#include "preproc/colour_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace belvedere {
namespace {

constexpr double kLeastGain = 1.0 / 3, kMostGain = 3, kMostOffset = 128;
constexpr double kApart = 8;       // of two samples, for the slope between them to tell something
constexpr size_t kSlopes = 16384;  // at most
constexpr int kRounds = 8;
constexpr double kDeviations = 2.5, kDeviationOfMedian = 1.4826;

struct Sample {
  double source = 0, below = 0;
};
struct Line {
  double gain = 1, offset = 0;
  double Residual(const Sample& sample) const { return sample.below - (gain * sample.source + offset); }
};

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The line of that gain, within its limits, that runs through the middle of the samples.
Line Through(const std::vector<Sample>& samples, double gain) {
  Line line{std::clamp(gain, kLeastGain, kMostGain), 0};
  std::vector<double> offsets;
  offsets.reserve(samples.size());
  for (const Sample& sample : samples) offsets.push_back(line.Residual(sample));
  line.offset = std::clamp(Median(offsets), -kMostOffset, kMostOffset);
  return line;
}

// Pairs are drawn by a linear congruential generator (Knuth's), always the same.
Line FirstLine(const std::vector<Sample>& samples) {
  std::vector<double> slopes;
  uint64_t state = 1;
  const auto draw = [&] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return samples[(state >> 33) % samples.size()];
  };
  for (size_t i = 0; i < 4 * kSlopes && slopes.size() < kSlopes; ++i) {
    const Sample a = draw(), b = draw();
    if (std::abs(a.source - b.source) >= kApart) slopes.push_back((a.below - b.below) / (a.source - b.source));
  }
  return Through(samples, slopes.size() < kSlopes / 64 ? 1.0 : Median(slopes));
}

std::vector<Sample> Near(const std::vector<Sample>& samples, const Line& line) {
  std::vector<double> distances;
  distances.reserve(samples.size());
  for (const Sample& sample : samples) distances.push_back(std::abs(line.Residual(sample)));
  const double most = kDeviations * std::max(kDeviationOfMedian * Median(distances), 1.0);
  std::vector<Sample> near;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(near),
               [&](const Sample& sample) { return std::abs(line.Residual(sample)) <= most; });
  return near;
}

Line LeastSquares(const std::vector<Sample>& samples, const Line& before) {
  const auto count = static_cast<double>(samples.size());
  double source = 0, below = 0, squares = 0, products = 0;
  for (const Sample& sample : samples) {
    source += sample.source / count;
    below += sample.below / count;
  }
  for (const Sample& sample : samples) {
    squares += (sample.source - source) * (sample.source - source);
    products += (sample.source - source) * (sample.below - below);
  }
  if (squares < count) return Through(samples, before.gain);  // hardly more than one colour
  const double gain = products / squares;
  const double clamped = std::clamp(gain, kLeastGain, kMostGain);
  return {clamped, std::clamp(below - clamped * source, -kMostOffset, kMostOffset)};
}

Line Fit(const std::vector<Sample>& samples) {
  Line line = FirstLine(samples);
  for (int round = 0; round < kRounds; ++round) line = LeastSquares(Near(samples, line), line);
  return line;
}

}  // namespace

ColourFit FitColours(std::span<const ColourPair> pairs) {
  ColourFit fit;
  if (pairs.empty()) return fit;
  for (size_t c = 0; c < 3; ++c) {
    std::vector<Sample> samples;
    samples.reserve(pairs.size());
    for (const ColourPair& pair : pairs)
      samples.push_back({static_cast<double>(pair.source[c]), static_cast<double>(pair.below[c])});
    const Line line = Fit(samples);
    fit.gain[c] = line.gain;
    fit.offset[c] = line.offset;
  }
  return fit;
}

}  // namespace belvedere

// Percentiles of a series of measurements, by nearest rank: each is a value that was measured.
//
// Threads: pure functions.
#pragma once

#include <span>

namespace belvedere {

struct Percentiles {
  double p50 = 0, p95 = 0, p99 = 0, max = 0;
};

// All zero for an empty series.
Percentiles PercentilesOf(std::span<const double> values);
// The smallest value that at least `share` (0..1) of the values do not exceed; 0 for an empty series.
double PercentileOf(std::span<const double> values, double share);
double MeanOf(std::span<const double> values);

}  // namespace belvedere

// Percentiles of a series of measurements, by nearest rank: each is a value that was measured.
//
// Threads: pure functions.
#pragma once

#include <span>
#include <vector>

namespace belvedere {

struct Percentiles {
  double p50 = 0, p95 = 0, p99 = 0, max = 0;
};

// All zero for an empty series.
Percentiles PercentilesOf(std::span<const double> values);
// The smallest value that at least `share` (0..1) of the values do not exceed; 0 for an empty series.
double PercentileOf(std::span<const double> values, double share);
double MeanOf(std::span<const double> values);
// Each value over the median of those at most reach_s away from it in time: what stands out among its like, where the
// whole series has phases that differ. REQUIRES: as many times, ascending.
std::vector<double> OverMedianAround(std::span<const double> times_s, std::span<const double> values, double reach_s);

}  // namespace belvedere

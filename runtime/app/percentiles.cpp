#include "runtime/app/percentiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace belvedere {
namespace {

double AtRank(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const double index = std::clamp(rank - 1, 0.0, static_cast<double>(sorted.size() - 1));
  return sorted[static_cast<size_t>(index)];
}

std::vector<double> Sorted(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

}  // namespace

Percentiles PercentilesOf(std::span<const double> values) {
  const std::vector<double> sorted = Sorted(values);
  if (sorted.empty()) return {};
  return {AtRank(sorted, 0.50), AtRank(sorted, 0.95), AtRank(sorted, 0.99), sorted.back()};
}

double PercentileOf(std::span<const double> values, double share) {
  return AtRank(Sorted(values), share);
}

double MeanOf(std::span<const double> values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace belvedere

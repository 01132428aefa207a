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

std::vector<double> OverMedianAround(std::span<const double> times_s, std::span<const double> values, double reach_s) {
  std::vector<double> over;
  over.reserve(values.size());
  std::vector<double> around;
  size_t first = 0, last = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    while (times_s[first] < times_s[i] - reach_s) ++first;
    while (last < values.size() && times_s[last] <= times_s[i] + reach_s) ++last;
    around.assign(values.begin() + static_cast<std::ptrdiff_t>(first),
                  values.begin() + static_cast<std::ptrdiff_t>(last));
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>((around.size() - 1) / 2);
    std::nth_element(around.begin(), middle, around.end());
    over.push_back(*middle > 0 ? values[i] / *middle : 1);
  }
  return over;
}

}  // namespace belvedere

#include "runtime/paging/layer_steps.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

namespace belvedere {
namespace {

constexpr double kSecondsPerDay = 86'400.0;
constexpr std::chrono::year kLeapYear{2004};

std::chrono::sys_days DayOf(double utc_s) {
  return std::chrono::sys_days{std::chrono::days{static_cast<int>(std::floor(utc_s / kSecondsPerDay))}};
}

}  // namespace

double SecondsIntoYear(double utc_s) {
  const std::chrono::sys_days day = DayOf(utc_s);
  const std::chrono::year_month_day date{day};
  const std::chrono::sys_days same{kLeapYear / date.month() / date.day()};
  const auto days = (same - std::chrono::sys_days{kLeapYear / std::chrono::January / 1}).count();
  const double of_day_s = utc_s - kSecondsPerDay * static_cast<double>(day.time_since_epoch().count());
  return kSecondsPerDay * static_cast<double>(days) + of_day_s;
}

int YearOf(double utc_s) {
  return static_cast<int>(std::chrono::year_month_day{DayOf(utc_s)}.year());
}

bool IsEarlier(double utc_s, double other_utc_s, Repeats repeats) {
  if (repeats == Repeats::kNever) return utc_s < other_utc_s;
  return SecondsIntoYear(utc_s) < SecondsIntoYear(other_utc_s);
}

size_t StepAt(std::span<const LayerStep> steps, Repeats repeats, double utc_s) {
  BELVEDERE_CHECK(!steps.empty());
  const auto next = std::upper_bound(steps.begin(), steps.end(), utc_s, [&](double time_s, const LayerStep& step) {
    return IsEarlier(time_s, step.utc_s, repeats);
  });
  if (next != steps.begin()) return static_cast<size_t>(std::distance(steps.begin(), next)) - 1;
  return repeats == Repeats::kNever ? 0 : steps.size() - 1;
}

}  // namespace belvedere

#include "runtime/base/iso_time.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstddef>

namespace belvedere {
namespace {

// Takes exactly `digits` digits from the front.
std::optional<int> TakeNumber(std::string_view& text, size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int value = 0;
  for (const char c : text.substr(0, digits)) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool Take(std::string_view& text, char wanted) {
  if (text.empty() || text.front() != wanted) return false;
  text.remove_prefix(1);
  return true;
}

// Seconds after midnight from "hh:mm[:ss[.fraction]]".
std::optional<double> TakeTimeOfDay(std::string_view& text) {
  const auto hour = TakeNumber(text, 2);
  if (!hour || *hour > 23 || !Take(text, ':')) return std::nullopt;
  const auto minute = TakeNumber(text, 2);
  if (!minute || *minute > 59) return std::nullopt;
  double seconds = *hour * 3600.0 + *minute * 60.0;
  if (!Take(text, ':')) return seconds;
  const auto whole = TakeNumber(text, 2);
  if (!whole || *whole > 60) return std::nullopt;
  seconds += *whole;
  if (!Take(text, '.')) return seconds;
  double place = 0.1;
  if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
  while (!text.empty() && text.front() >= '0' && text.front() <= '9') {
    seconds += (text.front() - '0') * place;
    place *= 0.1;
    text.remove_prefix(1);
  }
  return seconds;
}

// Seconds east of UTC from "Z", "+hh:mm", "-hh:mm" or nothing.
std::optional<double> TakeZone(std::string_view& text) {
  if (text.empty() || Take(text, 'Z')) return 0.0;
  const bool west = text.front() == '-';
  if (!Take(text, '+') && !Take(text, '-')) return std::nullopt;
  const auto hours = TakeNumber(text, 2);
  if (!hours || *hours > 23 || !Take(text, ':')) return std::nullopt;
  const auto minutes = TakeNumber(text, 2);
  if (!minutes || *minutes > 59) return std::nullopt;
  return (*hours * 3600.0 + *minutes * 60.0) * (west ? -1 : 1);
}

}  // namespace

std::optional<double> ParseIsoTime(std::string_view text) {
  const auto year = TakeNumber(text, 4);
  if (!year || !Take(text, '-')) return std::nullopt;
  const auto month = TakeNumber(text, 2);
  if (!month || !Take(text, '-')) return std::nullopt;
  const auto day = TakeNumber(text, 2);
  if (!day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year}, std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok()) return std::nullopt;
  const double midnight_s = 86'400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  if (text.empty()) return midnight_s;
  if (!Take(text, 'T') && !Take(text, ' ')) return std::nullopt;
  const auto seconds = TakeTimeOfDay(text);
  if (!seconds) return std::nullopt;
  const auto zone_s = TakeZone(text);
  if (!zone_s || !text.empty()) return std::nullopt;
  return midnight_s + *seconds - *zone_s;
}

std::string FormatIsoTime(double utc_s) {
  constexpr int64_t kSecondsPerDay = 86'400;
  const int64_t seconds = std::llround(utc_s);
  const int64_t day = seconds / kSecondsPerDay - (seconds % kSecondsPerDay < 0 ? 1 : 0);
  const std::chrono::year_month_day date{std::chrono::sys_days{std::chrono::days{day}}};
  const int64_t of_day = seconds - day * kSecondsPerDay;
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), of_day / 3600,
                     of_day / 60 % 60, of_day % 60);
}

}  // namespace belvedere

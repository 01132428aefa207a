// One-line messages for a person, to standard error.
//
// Info is for what a user would want to know without asking, Warning for what was wrong but gone on from, Error for
// what could not be done. A message names what, where and what to do. LogOnce-style limits are the caller's to keep:
// nothing that arrives from a network may log without a bound.
//
// Threads: any.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace belvedere {

enum class LogLevel { kInfo, kWarning, kError };

void LogLine(LogLevel level, std::string_view line);
// Lines under this level are dropped (default kInfo).
void SetLogLevel(LogLevel level);

template <typename... Args>
void LogInfo(fmt::format_string<Args...> format, Args&&... args) {
  LogLine(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void LogWarning(fmt::format_string<Args...> format, Args&&... args) {
  LogLine(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void LogError(fmt::format_string<Args...> format, Args&&... args) {
  LogLine(LogLevel::kError, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace belvedere

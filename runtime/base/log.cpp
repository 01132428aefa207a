#include "runtime/base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace belvedere {
namespace {

spdlog::logger& Logger() {
  static const auto kLogger = [] {
    auto logger =
        std::make_shared<spdlog::logger>("belvedere", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    logger->set_pattern("%H:%M:%S %^%l%$ %v");
    return logger;
  }();
  return *kLogger;
}

spdlog::level::level_enum SpdlogLevel(LogLevel level) {
  switch (level) {
    case LogLevel::kInfo: return spdlog::level::info;
    case LogLevel::kWarning: return spdlog::level::warn;
    case LogLevel::kError: return spdlog::level::err;
  }
  return spdlog::level::err;
}

}  // namespace

void LogLine(LogLevel level, std::string_view line) {
  Logger().log(SpdlogLevel(level), line);
}

void SetLogLevel(LogLevel level) {
  Logger().set_level(SpdlogLevel(level));
}

}  // namespace belvedere

#include "runtime/app/program.h"

#include "runtime/base/log.h"

#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace belvedere {
namespace {

volatile std::sig_atomic_t stop_asked = 0;
const std::chrono::steady_clock::time_point kProcessStart = std::chrono::steady_clock::now();
constexpr double kEquinoxNoonAtGreenwich_s = 1774008000;  // 2026-03-20T12:00:00Z
constexpr double kSecondsPerDegree = 240;

extern "C" void AskToStop(int) {
  stop_asked = 1;
}

}  // namespace

void CatchSignals() {
  struct sigaction action = {};
  action.sa_handler = AskToStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second one ends the program at once
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool StopAsked() {
  return stop_asked != 0;
}

int CouldNot(const Status& status) {
  LogError("{}", status.message());
  return kExitCouldNot;
}

std::optional<PictureSize> ParseSize(std::string_view text) {
  constexpr int kLeast_px = 16, kMost_px = 8192;
  const size_t times = text.find('x');
  if (times == std::string_view::npos) return std::nullopt;
  const auto number = [](std::string_view digits) {
    int value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size() ? value : 0;
  };
  const PictureSize size{number(text.substr(0, times)), number(text.substr(times + 1))};
  const auto fits = [](int pixels) { return pixels >= kLeast_px && pixels <= kMost_px; };
  if (!fits(size.width_px) || !fits(size.height_px)) return std::nullopt;
  return size;
}

double EquinoxNoonAt(double longitude_deg) {
  return kEquinoxNoonAtGreenwich_s - kSecondsPerDegree * longitude_deg;
}

Status WriteText(const std::string& path, std::string_view text) {
  const std::string beside = path + ".partial";
  {
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file << text;
    file.flush();
    if (!file) return Status::Error("{}: cannot be written; check the folder and the space on the disk", path);
  }
  std::error_code error;
  std::filesystem::rename(beside, path, error);
  if (error) return Status::Error("{}: cannot be moved into place: {}", path, error.message());
  return {};
}

double SecondsSinceStart() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - kProcessStart).count();
}

}  // namespace belvedere

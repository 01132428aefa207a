#include "dis/replay_clock.h"

#include <charconv>
#include <string>

namespace belvedere::dis {
namespace {

template <typename Number>
std::optional<Number> NumberIn(std::string_view text) {
  Number value{};
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

double ReplayClock::MomentAt(double now_s) const {
  return paused_ ? anchor_recording_s_ : anchor_recording_s_ + (now_s - anchor_now_s_) * speed_;
}

Status ReplayClock::Obey(std::string_view command, double now_s) {
  constexpr double kFastest = 1e6;
  const size_t space = command.find(' ');
  const std::string_view word = command.substr(0, space);
  const std::string_view rest = space == std::string_view::npos ? std::string_view() : command.substr(space + 1);
  const double moment_s = MomentAt(now_s);
  anchor_recording_s_ = moment_s;
  anchor_now_s_ = now_s;
  if (command == "pause") {
    paused_ = true;
    steps_ = 0;
  } else if (command == "go") {
    paused_ = false;
  } else if (const auto steps = NumberIn<uint64_t>(rest); word == "step" && (steps || rest.empty())) {
    paused_ = true;
    steps_ += steps.value_or(1);
  } else if (const auto speed = NumberIn<double>(rest); word == "speed" && speed && *speed > 0 && *speed <= kFastest) {
    speed_ = *speed;
  } else {
    return Status::Error("\"{}\" is no command of a replay; there are pause, go, step [N], speed X", command);
  }
  return {};
}

std::optional<double> ReplayClock::DueAt(double recording_s) const {
  if (!paused_) return anchor_now_s_ + (recording_s - anchor_recording_s_) / speed_;
  if (steps_ > 0) return anchor_now_s_;
  return std::nullopt;
}

void ReplayClock::Sent(double recording_s, double now_s) {
  if (!paused_) return;
  if (steps_ > 0) --steps_;
  anchor_recording_s_ = recording_s;
  anchor_now_s_ = now_s;
}

}  // namespace belvedere::dis

#include "runtime/app/command_text.h"

#include "runtime/app/layer_text.h"
#include "runtime/app/settings.h"

#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace belvedere {
namespace {

using Words = std::vector<std::string_view>;

Words WordsOf(std::string_view text) {
  Words words;
  while (true) {
    const size_t start = text.find_first_not_of(' ');
    if (start == std::string_view::npos) return words;
    const size_t end = text.find(' ', start);
    words.push_back(text.substr(start, end - start));
    if (end == std::string_view::npos) return words;
    text.remove_prefix(end);
  }
}

std::optional<double> NumberIn(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// The arguments as numbers, when there are `least` to `most` and all of them are.
std::optional<std::vector<double>> Numbers(const Words& words, size_t least, size_t most) {
  if (words.size() - 1 < least || words.size() - 1 > most) return std::nullopt;
  std::vector<double> numbers;
  for (size_t i = 1; i < words.size(); ++i) {
    const auto number = NumberIn(words[i]);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  numbers.resize(most, 0.0);
  return numbers;
}

using Parser = std::function<std::optional<Command>(const Words&, const PicturePoint& middle)>;
struct Form {
  std::string_view usage;
  Parser parse;
};

std::optional<Command> ParseError(const Words& words) {
  if (words.size() != 2) return std::nullopt;
  const bool factor = words[1].front() == '*';
  const auto number = NumberIn(words[1].substr(factor ? 1 : 0));
  if (!number || *number <= 0) return std::nullopt;
  if (factor) return ScaleErrorBoundCommand{*number};
  return ErrorBoundCommand{*number};
}

std::optional<Command> ParseToggle(const Words& words) {
  static const std::map<std::string_view, ViewSwitch> kSwitches = {
      {"hud", ViewSwitch::kHud},         {"labels", ViewSwitch::kLabels}, {"objects", ViewSwitch::kObjects},
      {"symbols", ViewSwitch::kSymbols}, {"sky", ViewSwitch::kSky},       {"wireframe", ViewSwitch::kWireframe},
      {"volumes", ViewSwitch::kVolumes}, {"pages", ViewSwitch::kPages},   {"frozen", ViewSwitch::kFrozen},
      {"effects", ViewSwitch::kEffects}, {"trails", ViewSwitch::kTrails}, {"vectors", ViewSwitch::kVectors},
      {"groups", ViewSwitch::kGroups},   {"frames", ViewSwitch::kFrames}};
  if (words.size() != 2) return std::nullopt;
  const auto found = kSwitches.find(words[1]);
  if (found == kSwitches.end()) return std::nullopt;
  return ToggleCommand{found->second};
}

std::optional<Command> ParseTint(const Words& words) {
  static const std::map<std::string_view, std::optional<GroundTint>> kTints = {
      {"none", GroundTint::kNone},   {"error", GroundTint::kError}, {"level", GroundTint::kLevel},
      {"frame", GroundTint::kFrame}, {"image", GroundTint::kImage}, {"next", std::nullopt}};
  if (words.size() != 2) return std::nullopt;
  const auto found = kTints.find(words[1]);
  if (found == kTints.end()) return std::nullopt;
  return TintCommand{found->second};
}

std::optional<Command> ParseLayer(const Words& words) {
  if (words.size() != 3) return std::nullopt;
  LayerUse unused;
  if (words[2] != "toggle" && !ApplyLayerSetting(words[2], unused).ok()) return std::nullopt;
  return LayerCommand{std::string(words[1]), std::string(words[2])};
}

std::optional<Command> ParseTarget(const Words& words) {
  if (words.size() != 2 || (words[1] != "next" && words[1] != "previous")) return std::nullopt;
  return CycleTargetCommand{words[1] == "next" ? 1 : -1};
}

std::optional<Command> ParseGoTo(const Words& words) {
  const auto n = Numbers(words, 3, 5);
  if (!n || std::abs((*n)[0]) > 90 || std::abs((*n)[1]) > 360) return std::nullopt;
  return GoToCommand{{(*n)[0], (*n)[1], (*n)[2]}, (*n)[3], words.size() == 6 ? (*n)[4] : -90.0};
}

std::optional<Command> ParseFly(const Words& words) {
  const auto n = Numbers(words, 3, 5);
  if (!n) return std::nullopt;
  for (const double rate : *n) {
    if (std::abs(rate) > 1) return std::nullopt;
  }
  return FlyCommand{(*n)[0], (*n)[1], (*n)[2], (*n)[3], (*n)[4]};
}

template <typename T>
Parser Alone() {
  return [](const Words& words, const PicturePoint&) -> std::optional<Command> {
    if (words.size() != 1) return std::nullopt;
    return T{};
  };
}

const std::map<std::string_view, Form>& Forms() {
  static const std::map<std::string_view, Form> kForms = {
      {"zoom",
       {"zoom STEPS",
        [](const Words& words, const PicturePoint& middle) -> std::optional<Command> {
          const auto n = Numbers(words, 1, 1);
          if (!n) return std::nullopt;
          return ZoomCommand{middle, (*n)[0]};
        }}},
      {"look",
       {"look RIGHT UP",
        [](const Words& words, const PicturePoint&) -> std::optional<Command> {
          const auto n = Numbers(words, 2, 2);
          if (!n) return std::nullopt;
          return LookCommand{(*n)[0], (*n)[1]};
        }}},
      {"orbit",
       {"orbit AROUND_DEG TILT_DEG",
        [](const Words& words, const PicturePoint& middle) -> std::optional<Command> {
          const auto n = Numbers(words, 2, 2);
          if (!n) return std::nullopt;
          return OrbitCommand{middle, (*n)[0], (*n)[1]};
        }}},
      {"time",
       {"time +SECONDS or -SECONDS",
        [](const Words& words, const PicturePoint&) -> std::optional<Command> {
          const auto n = Numbers(words, 1, 1);
          if (!n) return std::nullopt;
          return AdvanceTimeCommand{(*n)[0]};
        }}},
      {"fly",
       {"fly FORWARD RIGHT UP [TURN PITCH], each -1 to 1",
        [](const Words& words, const PicturePoint&) { return ParseFly(words); }}},
      {"goto",
       {"goto LAT LON HEIGHT_M [HEADING PITCH]",
        [](const Words& words, const PicturePoint&) { return ParseGoTo(words); }}},
      {"error",
       {"error PX or error *FACTOR", [](const Words& words, const PicturePoint&) { return ParseError(words); }}},
      {"toggle",
       {"toggle hud, labels, objects, symbols, sky, wireframe, volumes, pages, frozen, effects, trails, vectors, "
        "groups or frames",
        [](const Words& words, const PicturePoint&) { return ParseToggle(words); }}},
      {"tint",
       {"tint none, error, level, frame, image or next",
        [](const Words& words, const PicturePoint&) { return ParseTint(words); }}},
      {"layer",
       {"layer NAME|NUMBER toggle|on|off|opacity=0..1|gamma=0.1..10|multiplier=0..100|role=ROLE",
        [](const Words& words, const PicturePoint&) { return ParseLayer(words); }}},
      {"target",
       {"target next or target previous", [](const Words& words, const PicturePoint&) { return ParseTarget(words); }}},
      {"watch",
       {"watch none",
        [](const Words& words, const PicturePoint&) -> std::optional<Command> {
          if (words.size() != 2 || words[1] != "none") return std::nullopt;
          return ForgetWatchedCommand{};
        }}},
      {"picture", {"picture", Alone<PictureCommand>()}},
      {"home", {"home", Alone<HomeCommand>()}},
      {"quit", {"quit", Alone<QuitCommand>()}},
  };
  return kForms;
}

}  // namespace

Result<Command> ParseCommand(std::string_view text, int width_px, int height_px) {
  const Words words = WordsOf(text);
  if (words.empty()) return Status::Error("an empty command");
  const auto form = Forms().find(words[0]);
  if (form == Forms().end()) {
    std::vector<std::string> names;
    for (const auto& [name, unused] : Forms()) names.emplace_back(name);
    const std::string nearest = NearestWord(words[0], names);
    return Status::Error("\"{}\" is not a command; {}", words[0],
                         nearest.empty() ? fmt::format("commands are {}", fmt::join(names, ", "))
                                         : fmt::format("did you mean {}?", nearest));
  }
  const auto command = form->second.parse(words, {0.5 * width_px, 0.5 * height_px});
  if (!command) return Status::Error("\"{}\" must be written: {}", text, form->second.usage);
  return *command;
}

}  // namespace belvedere

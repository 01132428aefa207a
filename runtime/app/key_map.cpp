#include "runtime/app/key_map.h"

#include "runtime/app/command_text.h"
#include "runtime/app/settings.h"

#include <cctype>
#include <utility>

namespace belvedere {
namespace {

constexpr std::pair<std::string_view, std::string_view> kStockKeys[] = {
    {"h", "toggle hud"},     {"l", "toggle labels"},    {"o", "toggle objects"},       {"m", "toggle symbols"},
    {"k", "toggle sky"},     {"x", "toggle wireframe"}, {"f", "toggle frozen"},        {"c", "toggle frozen"},
    {"t", "tint next"},      {"u", "toggle volumes"},   {"i", "toggle pages"},         {"1", "layer 1 toggle"},
    {"2", "layer 2 toggle"}, {"3", "layer 3 toggle"},   {"4", "layer 4 toggle"},       {"5", "layer 5 toggle"},
    {"6", "layer 6 toggle"}, {"n", "target next"},      {"b", "target previous"},      {"p", "picture"},
    {"Home", "home"},        {"Escape", "quit"},        {"shift+=", "zoom 1"},         {"=", "zoom 1"},
    {"-", "zoom -1"},        {"KeypadAdd", "zoom 1"},   {"KeypadSubtract", "zoom -1"}, {"[", "error *0.8"},
    {"]", "error *1.25"},    {"PageUp", "orbit 0 5"},   {"PageDown", "orbit 0 -5"},    {",", "time -600"},
    {".", "time +600"},      {"e", "toggle effects"},   {"y", "toggle trails"},        {"v", "toggle vectors"},
    {"g", "toggle groups"},  {"Delete", "watch none"},
};

const std::map<std::string, Key>& KeyNames() {
  static const std::map<std::string, Key> kNames = [] {
    std::map<std::string, Key> names = {{"Escape", Key::kEscape},
                                        {"Enter", Key::kEnter},
                                        {"Tab", Key::kTab},
                                        {"Backspace", Key::kBackspace},
                                        {"Insert", Key::kInsert},
                                        {"Delete", Key::kDelete},
                                        {"Right", Key::kRight},
                                        {"Left", Key::kLeft},
                                        {"Down", Key::kDown},
                                        {"Up", Key::kUp},
                                        {"PageUp", Key::kPageUp},
                                        {"PageDown", Key::kPageDown},
                                        {"Home", Key::kHome},
                                        {"End", Key::kEnd},
                                        {"KeypadAdd", Key::kKeypadAdd},
                                        {"KeypadSubtract", Key::kKeypadSubtract},
                                        {"Space", KeyOf(' ')}};
    for (int n = 1; n <= 12; ++n) {
      names.emplace("F" + std::to_string(n), static_cast<Key>(static_cast<int>(Key::kF1) + n - 1));
    }
    return names;
  }();
  return kNames;
}

Result<Key> ParseKey(std::string_view text) {
  if (text.size() == 1 && std::isgraph(static_cast<unsigned char>(text[0])) != 0) {
    return KeyOf(static_cast<char>(std::toupper(static_cast<unsigned char>(text[0]))));
  }
  const auto found = KeyNames().find(std::string(text));
  if (found != KeyNames().end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, unused] : KeyNames()) names.push_back(name);
  const std::string nearest = NearestWord(text, names);
  if (nearest.empty()) return Status::Error("\"{}\" is not the name of a key", text);
  return Status::Error("\"{}\" is not the name of a key; did you mean {}?", text, nearest);
}

}  // namespace

Result<KeyStroke> ParseKeyStroke(std::string_view text) {
  KeyStroke stroke;
  constexpr std::string_view kShift = "shift+", kControl = "control+", kAlt = "alt+";
  while (true) {
    if (text.starts_with(kShift)) {
      stroke.shift = true;
      text.remove_prefix(kShift.size());
    } else if (text.starts_with(kControl)) {
      stroke.control = true;
      text.remove_prefix(kControl.size());
    } else if (text.starts_with(kAlt)) {
      stroke.alt = true;
      text.remove_prefix(kAlt.size());
    } else {
      break;
    }
  }
  const Result<Key> key = ParseKey(text);
  if (!key.ok()) return key.status();
  stroke.key = *key;
  return stroke;
}

KeyMap::KeyMap() {
  for (const auto& [key, command] : kStockKeys) BELVEDERE_CHECK(Bind(key, command).ok());
}

Status KeyMap::Bind(std::string_view key, std::string_view command) {
  const Result<KeyStroke> stroke = ParseKeyStroke(key);
  if (!stroke.ok()) return stroke.status();
  if (command.empty()) {
    commands_.erase(*stroke);
    return {};
  }
  const Result<Command> parsed = ParseCommand(command, 2, 2);
  if (!parsed.ok()) return parsed.status();
  commands_[*stroke] = command;
  return {};
}

std::optional<std::string> KeyMap::CommandOf(const KeyStroke& stroke) const {
  const auto found = commands_.find(stroke);
  if (found == commands_.end()) return std::nullopt;
  return found->second;
}

std::optional<FlyCommand> FlightKeys::Press(Key key, bool pressed) {
  static const std::set<Key> kFlight = {KeyOf('W'), KeyOf('S'), KeyOf('A'), KeyOf('D'), KeyOf('Q'),
                                        KeyOf('E'), Key::kUp,   Key::kDown, Key::kLeft, Key::kRight};
  if (!kFlight.contains(key)) return std::nullopt;
  const bool changed = pressed ? down_.insert(key).second : down_.erase(key) > 0;
  if (!changed) return std::nullopt;
  return rates();
}

FlyCommand FlightKeys::rates() const {
  const auto balance = [&](Key plus, Key minus) {
    return (down_.contains(plus) ? 1.0 : 0.0) - (down_.contains(minus) ? 1.0 : 0.0);
  };
  return {balance(KeyOf('W'), KeyOf('S')), balance(KeyOf('D'), KeyOf('A')), balance(KeyOf('E'), KeyOf('Q')),
          balance(Key::kRight, Key::kLeft), balance(Key::kUp, Key::kDown)};
}

}  // namespace belvedere

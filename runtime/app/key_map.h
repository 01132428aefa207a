// KeyMap: which command each key gives, and what the keys that fly are doing.
//
// A key is written as "h", "F1", "shift+PageUp"; letters are the keys, whatever the case. Keys that fly are held: W S
// forward and back, A D sideways, Q E down and up, the arrows turn. All others give their command when pressed.
//
// Threads: the UI thread.
#pragma once

#include "runtime/base/status.h"
#include "runtime/scene/commands.h"
#include "runtime/scene/input.h"

#include <compare>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

struct KeyStroke {
  Key key = Key::kUnknown;
  bool shift = false, control = false, alt = false;
  auto operator<=>(const KeyStroke&) const = default;
};
Result<KeyStroke> ParseKeyStroke(std::string_view text);

class KeyMap {
 public:
  KeyMap();  // the stock keys of docs/manual.md
  // Gives a key another command, in its written form (command_text.h); an empty one takes the key's command away.
  Status Bind(std::string_view key, std::string_view command);
  // The command's written form; nullopt when the key has none.
  std::optional<std::string> CommandOf(const KeyStroke& stroke) const;

 private:
  std::map<KeyStroke, std::string> commands_;
};

// The keys that are down in one window, as rates to fly with.
class FlightKeys {
 public:
  // nullopt when the key is not one that flies, or nothing changed.
  std::optional<FlyCommand> Press(Key key, bool pressed);
  FlyCommand rates() const;

 private:
  std::set<Key> down_;
};

}  // namespace belvedere

// InputEvent: what a person did in one window, as plain values, from the windows to the UI thread.
//
// Units:   pixels from the window's upper left corner, y downwards; scroll in wheel clicks, positive away from the
// user. Threads: values; events come from and go to the UI thread.
#pragma once

#include <cstdint>

namespace belvedere {

using WindowId = uint32_t;

// Keys that have no character. A key with one is named by it: letters as capitals ('A'), digits, ' ' and punctuation as
// on a US keyboard, whatever the layout prints.
enum class Key : uint16_t {
  kUnknown = 0,
  kEscape = 256,
  kEnter,
  kTab,
  kBackspace,
  kInsert,
  kDelete,
  kRight,
  kLeft,
  kDown,
  kUp,
  kPageUp,
  kPageDown,
  kHome,
  kEnd,
  kF1 = 290,  // kF1 + n is F(n+1), up to F12
  kF12 = 301,
  kKeypadAdd = 334,
  kKeypadSubtract,
  kLeftShift = 340,
  kLeftControl,
  kLeftAlt,
  kRightShift = 344,
  kRightControl,
  kRightAlt,
};
constexpr Key KeyOf(char character) {
  return static_cast<Key>(character);
}

enum class MouseButton : uint8_t { kLeft, kRight, kMiddle };

struct Modifiers {
  bool shift = false, control = false, alt = false;
  bool operator==(const Modifiers&) const = default;
};

struct InputEvent {
  enum class Kind : uint8_t { kKey, kMouseButton, kMouseMove, kScroll, kResize, kClose };
  Kind kind = Kind::kKey;
  WindowId window = 0;

  Key key = Key::kUnknown;            // kKey
  bool pressed = false;               // kKey, kMouseButton: pressed or released
  bool repeated = false;              // kKey: pressed for long
  MouseButton button{};               // kMouseButton
  Modifiers modifiers;                // kKey, kMouseButton
  double x = 0, y = 0;                // where the cursor is: kMouseButton, kMouseMove, kScroll
  double scroll_x = 0, scroll_y = 0;  // kScroll
  int width_px = 0, height_px = 0;    // kResize: of the picture
  double time_s = 0;                  // clock time of the poll that brought it
};

}  // namespace belvedere

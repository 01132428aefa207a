// Gestures: what the mouse and the keys do in one window, turned into commands.
//
//   left drag           grab and pan the ground under the cursor
//   wheel               zoom to the cursor, kZoomShare of the distance a click
//   right drag          orbit about the ground under the cursor where the drag began: around, and tilt
//   middle drag, or left drag with shift held: look around
//   left drag with control held: draws a watch area about where the drag began; a click takes one away
//   keys                as the KeyMap and FlightKeys say
//
// Threads: the UI thread; one for each window.
#pragma once

#include "runtime/app/key_map.h"
#include "runtime/scene/commands.h"
#include "runtime/scene/input.h"

#include <vector>

namespace belvedere {

class Gestures {
 public:
  explicit Gestures(const KeyMap& keys) : keys_(keys) {}

  // width_px, height_px: of the window's picture now.
  std::vector<Command> Take(const InputEvent& event, int width_px, int height_px);

 private:
  enum class Drag : uint8_t { kNone, kPan, kOrbit, kLook, kWatch };
  std::vector<Command> TakeKey(const InputEvent& event, int width_px, int height_px);
  std::vector<Command> TakeButton(const InputEvent& event);
  std::vector<Command> TakeMove(const InputEvent& event, int width_px, int height_px);

  const KeyMap& keys_;
  FlightKeys flight_;
  Drag drag_ = Drag::kNone;
  MouseButton button_{};  // that began the drag
  PicturePoint began_;
  PicturePoint last_;
};

}  // namespace belvedere

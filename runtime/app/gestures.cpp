#include "runtime/app/gestures.h"

#include "runtime/app/command_text.h"

#include <utility>

namespace belvedere {
namespace {

constexpr double kOrbitDegreesPerPicture = 180.0;  // a drag across the whole picture

bool GoesOnWhileHeld(const Command& command) {
  return std::holds_alternative<ZoomCommand>(command) || std::holds_alternative<OrbitCommand>(command) ||
         std::holds_alternative<LookCommand>(command) || std::holds_alternative<AdvanceTimeCommand>(command);
}

}  // namespace

std::vector<Command> Gestures::Take(const InputEvent& event, int width_px, int height_px) {
  switch (event.kind) {
    case InputEvent::Kind::kKey: return TakeKey(event, width_px, height_px);
    case InputEvent::Kind::kMouseButton: return TakeButton(event);
    case InputEvent::Kind::kMouseMove: return TakeMove(event, width_px, height_px);
    case InputEvent::Kind::kScroll:
      if (event.scroll_y == 0) return {};
      return {ZoomCommand{{event.x, event.y}, event.scroll_y}};
    case InputEvent::Kind::kClose: return {QuitCommand{}};
    case InputEvent::Kind::kResize: break;
  }
  return {};
}

std::vector<Command> Gestures::TakeKey(const InputEvent& event, int width_px, int height_px) {
  const KeyStroke stroke{event.key, event.modifiers.shift, event.modifiers.control, event.modifiers.alt};
  if (event.pressed) {
    if (const auto text = keys_.CommandOf(stroke)) {
      const Result<Command> command = ParseCommand(*text, width_px, height_px);
      if (command.ok() && (!event.repeated || GoesOnWhileHeld(*command))) return {*command};
      return {};
    }
  }
  if (const auto rates = flight_.Press(event.key, event.pressed)) return {*rates};
  return {};
}

std::vector<Command> Gestures::TakeButton(const InputEvent& event) {
  const PicturePoint at{event.x, event.y};
  if (!event.pressed) {
    if (event.button != button_) return {};
    const Drag ended = std::exchange(drag_, Drag::kNone);
    if (ended == Drag::kWatch) return {WatchCommand{began_, at, true}};
    return {};
  }
  if (drag_ != Drag::kNone) return {};
  button_ = event.button;
  began_ = last_ = at;
  if (event.button == MouseButton::kRight) {
    drag_ = Drag::kOrbit;
    return {};
  }
  if (event.button == MouseButton::kMiddle || event.modifiers.shift) {
    drag_ = Drag::kLook;
    return {};
  }
  if (event.modifiers.control) {
    drag_ = Drag::kWatch;
    return {};
  }
  drag_ = Drag::kPan;
  return {GrabCommand{at}};
}

std::vector<Command> Gestures::TakeMove(const InputEvent& event, int width_px, int height_px) {
  const PicturePoint before = last_;
  last_ = {event.x, event.y};
  const double right = (last_.x_px - before.x_px) / width_px;
  const double down = (last_.y_px - before.y_px) / height_px;
  switch (drag_) {
    case Drag::kNone: break;
    case Drag::kPan: return {PanCommand{last_}};
    case Drag::kOrbit: return {OrbitCommand{began_, -right * kOrbitDegreesPerPicture, -down * kOrbitDegreesPerPicture}};
    // The scene follows the cursor: dragging right turns the camera left.
    case Drag::kLook: return {LookCommand{-right, down}};
    case Drag::kWatch: return {WatchCommand{began_, last_, false}};
  }
  return {};
}

}  // namespace belvedere

#include "runtime/app/command_text.h"
#include "runtime/app/gestures.h"
#include "runtime/app/key_map.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

namespace belvedere {
namespace {

template <typename T>
T Parsed(const std::string& text) {
  const Result<Command> command = ParseCommand(text, 100, 60);
  EXPECT_TRUE(command.ok()) << command.message();
  EXPECT_TRUE(std::holds_alternative<T>(*command)) << text;
  return std::get<T>(*command);
}

InputEvent KeyEvent(Key key, bool pressed) {
  InputEvent event;
  event.kind = InputEvent::Kind::kKey;
  event.key = key;
  event.pressed = pressed;
  return event;
}
InputEvent ButtonEvent(MouseButton button, bool pressed, double x, double y, bool shift = false) {
  InputEvent event;
  event.kind = InputEvent::Kind::kMouseButton;
  event.button = button;
  event.pressed = pressed;
  event.x = x;
  event.y = y;
  event.modifiers.shift = shift;
  return event;
}
InputEvent MoveEvent(double x, double y) {
  InputEvent event;
  event.kind = InputEvent::Kind::kMouseMove;
  event.x = x;
  event.y = y;
  return event;
}

TEST(CommandTextTest, ReadsEveryForm) {
  EXPECT_EQ(Parsed<ZoomCommand>("zoom -2").steps, -2);
  EXPECT_EQ(Parsed<ZoomCommand>("zoom 1").at.x_px, 50);
  EXPECT_EQ(Parsed<OrbitCommand>("orbit 10 -5").tilt_deg, -5);
  EXPECT_EQ(Parsed<LookCommand>("look 0.5 0").right_fraction, 0.5);
  EXPECT_EQ(Parsed<FlyCommand>("fly 1 0 -1").up, -1);
  const auto go = Parsed<GoToCommand>("goto 36.5 -118.3 9000 20 -30");
  EXPECT_EQ(go.position, (Geodetic{36.5, -118.3, 9000}));
  EXPECT_EQ(go.pitch_deg, -30);
  EXPECT_EQ(Parsed<GoToCommand>("goto 1 2 3").pitch_deg, -90);
  EXPECT_EQ(Parsed<ErrorBoundCommand>("error 1.5").error_px, 1.5);
  EXPECT_EQ(Parsed<ScaleErrorBoundCommand>("error *0.8").factor, 0.8);
  EXPECT_EQ(Parsed<ToggleCommand>("toggle wireframe").what, ViewSwitch::kWireframe);
  EXPECT_EQ(Parsed<ToggleCommand>("toggle volumes").what, ViewSwitch::kVolumes);
  EXPECT_EQ(Parsed<ToggleCommand>("toggle pages").what, ViewSwitch::kPages);
  EXPECT_EQ(Parsed<TintCommand>("tint level").tint, GroundTint::kLevel);
  EXPECT_EQ(Parsed<TintCommand>("tint next").tint, std::nullopt);
  EXPECT_EQ(Parsed<LayerCommand>("layer relief opacity=0.5").setting, "opacity=0.5");
  EXPECT_EQ(Parsed<LayerCommand>("layer 2 toggle").layer, "2");
  EXPECT_EQ(Parsed<CycleTargetCommand>("target previous").by, -1);
  EXPECT_EQ(Parsed<AdvanceTimeCommand>("time +600").seconds, 600);
  Parsed<PictureCommand>("picture");
  Parsed<HomeCommand>("home");
  Parsed<QuitCommand>("quit");
}

TEST(CommandTextTest, SaysHowItMustBeWritten) {
  EXPECT_NE(ParseCommand("zoom", 1, 1).message().find("must be written: zoom STEPS"), std::string::npos);
  EXPECT_NE(ParseCommand("zoon 1", 1, 1).message().find("did you mean zoom?"), std::string::npos);
  for (const char* bad :
       {"", "goto 91 0 0", "error 0", "error -1", "error *x", "toggle", "toggle earth", "fly 2 0 0", "quit now",
        "time x", "layer relief", "layer relief opacity=2", "layer relief bright", "tint", "tint red"}) {
    EXPECT_FALSE(ParseCommand(bad, 1, 1).ok()) << bad;
  }
}

TEST(KeyMapTest, BindsAndUnbinds) {
  KeyMap keys;
  EXPECT_EQ(keys.CommandOf({KeyOf('H')}), "toggle hud");
  EXPECT_TRUE(keys.Bind("control+F5", "picture").ok());
  EXPECT_EQ(keys.CommandOf({static_cast<Key>(static_cast<int>(Key::kF1) + 4), false, true, false}), "picture");
  EXPECT_TRUE(keys.Bind("h", "").ok());
  EXPECT_FALSE(keys.CommandOf({KeyOf('H')}).has_value());
  EXPECT_FALSE(keys.Bind("F13", "home").ok());
  EXPECT_FALSE(keys.Bind("F1", "hom").ok());
}

TEST(GesturesTest, LeftDragGrabsAndPans) {
  const KeyMap keys;
  Gestures gestures(keys);
  EXPECT_TRUE(gestures.Take(MoveEvent(1, 1), 100, 60).empty());
  const auto grabbed = gestures.Take(ButtonEvent(MouseButton::kLeft, true, 10, 20), 100, 60);
  ASSERT_EQ(grabbed.size(), 1U);
  EXPECT_EQ(std::get<GrabCommand>(grabbed[0]).at.y_px, 20);
  const auto panned = gestures.Take(MoveEvent(15, 25), 100, 60);
  ASSERT_EQ(panned.size(), 1U);
  EXPECT_EQ(std::get<PanCommand>(panned[0]).to.x_px, 15);
  gestures.Take(ButtonEvent(MouseButton::kLeft, false, 15, 25), 100, 60);
  EXPECT_TRUE(gestures.Take(MoveEvent(16, 26), 100, 60).empty());
}

TEST(GesturesTest, RightDragOrbitsAndShiftDragLooks) {
  const KeyMap keys;
  Gestures gestures(keys);
  gestures.Take(ButtonEvent(MouseButton::kRight, true, 50, 30), 100, 60);
  const auto orbit = std::get<OrbitCommand>(gestures.Take(MoveEvent(60, 30), 100, 60).at(0));
  EXPECT_EQ(orbit.about.x_px, 50);
  EXPECT_NEAR(orbit.around_deg, -18, 1e-9);
  gestures.Take(ButtonEvent(MouseButton::kRight, false, 60, 30), 100, 60);
  gestures.Take(ButtonEvent(MouseButton::kLeft, true, 60, 30, true), 100, 60);
  const auto look = std::get<LookCommand>(gestures.Take(MoveEvent(70, 36), 100, 60).at(0));
  EXPECT_NEAR(look.right_fraction, -0.1, 1e-9);
  EXPECT_NEAR(look.up_fraction, 0.1, 1e-9);
}

TEST(GesturesTest, ControlDragDrawsAWatchArea) {
  const KeyMap keys;
  Gestures gestures(keys);
  InputEvent press = ButtonEvent(MouseButton::kLeft, true, 50, 30);
  press.modifiers.control = true;
  EXPECT_TRUE(gestures.Take(press, 100, 60).empty());
  const auto drawn = std::get<WatchCommand>(gestures.Take(MoveEvent(60, 35), 100, 60).at(0));
  EXPECT_FALSE(drawn.finished);
  EXPECT_EQ(drawn.middle.x_px, 50);
  EXPECT_EQ(drawn.rim.y_px, 35);
  const auto kept =
      std::get<WatchCommand>(gestures.Take(ButtonEvent(MouseButton::kLeft, false, 70, 40), 100, 60).at(0));
  EXPECT_TRUE(kept.finished);
  EXPECT_EQ(kept.rim.x_px, 70);
  EXPECT_TRUE(gestures.Take(MoveEvent(80, 40), 100, 60).empty());
  EXPECT_TRUE(std::holds_alternative<ForgetWatchedCommand>(gestures.Take(KeyEvent(Key::kDelete, true), 100, 60).at(0)));
}

TEST(GesturesTest, KeysFlyWhileHeldAndTogglesDoNotRepeat) {
  const KeyMap keys;
  Gestures gestures(keys);
  EXPECT_EQ(std::get<FlyCommand>(gestures.Take(KeyEvent(KeyOf('W'), true), 100, 60).at(0)).forward, 1);
  EXPECT_TRUE(gestures.Take(KeyEvent(KeyOf('W'), true), 100, 60).empty());
  EXPECT_EQ(std::get<FlyCommand>(gestures.Take(KeyEvent(KeyOf('D'), true), 100, 60).at(0)).right, 1);
  gestures.Take(KeyEvent(KeyOf('D'), false), 100, 60);
  EXPECT_TRUE(std::get<FlyCommand>(gestures.Take(KeyEvent(KeyOf('W'), false), 100, 60).at(0)).is_still());
  InputEvent held = KeyEvent(KeyOf('H'), true);
  EXPECT_EQ(gestures.Take(held, 100, 60).size(), 1U);
  held.repeated = true;
  EXPECT_TRUE(gestures.Take(held, 100, 60).empty());
}

TEST(GesturesTest, WheelZoomsAtTheCursorAndCloseQuits) {
  const KeyMap keys;
  Gestures gestures(keys);
  InputEvent scroll;
  scroll.kind = InputEvent::Kind::kScroll;
  scroll.x = 33;
  scroll.scroll_y = 2;
  const auto zoom = std::get<ZoomCommand>(gestures.Take(scroll, 100, 60).at(0));
  EXPECT_EQ(zoom.at.x_px, 33);
  EXPECT_EQ(zoom.steps, 2);
  InputEvent close;
  close.kind = InputEvent::Kind::kClose;
  EXPECT_TRUE(std::holds_alternative<QuitCommand>(gestures.Take(close, 100, 60).at(0)));
}

}  // namespace
}  // namespace belvedere

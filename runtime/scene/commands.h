// Command: one thing that a user, a key, a line of a station file or a program asks of a view or of the whole station.
//
// Whatever its origin, a wish becomes one of these types before anything is done about it; the UI thread alone carries
// them out. runtime/app/command_text.h gives each its written form ("toggle hud", "error 1.5").
//
// Units: pixels from the top left of the view's picture; fractions of the picture's width or height; degrees; metres.
// Threads: values.
#pragma once

#include "runtime/base/view_id.h"
#include "runtime/earth/units.h"
#include "runtime/scene/view_parameters.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace belvedere {

// A place in the picture of a view.
struct PicturePoint {
  double x_px = 0, y_px = 0;
};

// Takes hold of the ground under the point, and later brings that same ground under another point.
struct GrabCommand {
  PicturePoint at;
};
struct PanCommand {
  PicturePoint to;
};
// Goes towards the ground under the point by a fixed share of the distance a step; negative steps go away from it.
struct ZoomCommand {
  PicturePoint at;
  double steps = 0;
};
// Turns the camera about the ground under the point: around its upright, and up and down.
struct OrbitCommand {
  PicturePoint about;
  double around_deg = 0, tilt_deg = 0;
};
// Turns the camera where it stands. Fractions of the picture: one whole width turns by the field of view.
struct LookCommand {
  double right_fraction = 0, up_fraction = 0;
};
// A watch area: the circle on the ground about `middle` through `rim`, shown while it is drawn and kept when finished.
// Where both are all but one point, what is being drawn is given up, or the watch area that lies there is taken away.
struct WatchCommand {
  PicturePoint middle, rim;
  bool finished = true;
};
struct ForgetWatchedCommand {};  // takes all of them away
// How fast to fly from now on, each -1 .. 1 of full speed, until the next FlyCommand.
struct FlyCommand {
  double forward = 0, right = 0, up = 0;
  double turn_right = 0, pitch_up = 0;
  bool is_still() const { return forward == 0 && right == 0 && up == 0 && turn_right == 0 && pitch_up == 0; }
};
struct GoToCommand {
  Geodetic position;
  double heading_deg = 0, pitch_deg = -90;
};
// Follows the next (or, negative, an earlier) moving object of the same domain.
struct CycleTargetCommand {
  int by = 1;
};
struct ErrorBoundCommand {
  double error_px = 2;
};
struct ScaleErrorBoundCommand {
  double factor = 1;
};
enum class ViewSwitch : uint8_t {
  kHud,
  kLabels,
  kObjects,
  kSymbols,
  kSky,
  kWireframe,
  kVolumes,
  kPages,
  kFrozen,
  kEffects,
  kTrails,
  kVectors,
  kGroups,
  kFrames,
};
struct ToggleCommand {
  ViewSwitch what = ViewSwitch::kHud;
};
struct TintCommand {
  std::optional<GroundTint> tint;  // nullopt: the one after that of now
};
// Changes one image layer of the view, by its name or its place counted from 1; a view without it stays as it is.
struct LayerCommand {
  std::string layer;
  std::string setting;  // "toggle", or as runtime/app/layer_text.h has it: "off", "opacity=0.5"
};
// Moves the simulated time of day, of all views.
struct AdvanceTimeCommand {
  double seconds = 0;
};
struct PictureCommand {};  // writes the view's picture to a file
struct HomeCommand {};     // back to where the station file put the view
struct QuitCommand {};

using Command =
    std::variant<GrabCommand, PanCommand, ZoomCommand, OrbitCommand, LookCommand, WatchCommand, ForgetWatchedCommand,
                 FlyCommand, GoToCommand, CycleTargetCommand, ErrorBoundCommand, ScaleErrorBoundCommand, ToggleCommand,
                 TintCommand, LayerCommand, AdvanceTimeCommand, PictureCommand, HomeCommand, QuitCommand>;

struct ViewCommand {
  ViewId view = 0;
  Command command;
};

}  // namespace belvedere

// Tether: a camera that hangs on a moving object and looks at it, from behind, beside or above.
//
// The object is the middle of a sphere; the camera sits on it at distance_m, `azimuth_deg` round (0 behind the object,
// or south of it when the tether does not follow the heading) and `elevation_deg` up. Elevation 90 looks straight down:
// the God's eye. The camera moves as the object does, so that between two published values both are moved on alike.
//
// Units: metres, degrees.
// Threads: pure functions.
#pragma once

#include "runtime/app/navigation.h"
#include "runtime/scene/motion.h"

namespace belvedere {

struct Tether {
  double distance_m = 200;
  double azimuth_deg = 0;
  double elevation_deg = 12;
  bool follows_heading = true;
};

inline constexpr double kShortestTether_m = 2.0;
inline constexpr double kLongestTether_m = 50e6;

// Where the camera of a tether is. The ground may lift it; it looks at the target all the same.
Camera CameraOf(const Tether& tether, const Pose& target, const GroundHeight& ground);

Tether Orbited(const Tether& tether, double around_deg, double tilt_deg);
Tether Zoomed(const Tether& tether, double steps);

}  // namespace belvedere

// Overview: the map. Looks straight down, north up, without perspective; pans and zooms.
//
// Units: degrees, metres; pixels from the top left.
// Threads: pure functions.
#pragma once

#include "runtime/app/navigation.h"

namespace belvedere {

struct Overview {
  double latitude_deg = 0, longitude_deg = 0;  // in the middle of the picture
  double span_m = 10e6;                        // of ground that the height of the picture covers
};

inline constexpr double kLeastSpan_m = 50.0;
inline constexpr double kWidestSpan_m = 16e6;
// North is up only where there is a north.
inline constexpr double kOverviewNorthernmost_deg = 89.9;

// High enough that the horizon lies outside the picture.
Camera CameraOf(const Overview& overview);

// The place on the ellipsoid under the point; off the Earth, the nearest on its limb.
Geodetic PlaceUnder(const Overview& overview, const Lens& lens, const PicturePoint& point);
// The place `held` under the point `to`.
Overview Panned(const Overview& overview, const Lens& lens, const Geodetic& held, const PicturePoint& to);
// The span shrunk by the fixed share a step; the place under the point stays there.
Overview Zoomed(const Overview& overview, const Lens& lens, const PicturePoint& at, double steps);

}  // namespace belvedere

// Height of the ground above the ellipsoid, metres, at a latitude and longitude in degrees: whoever has terrain gives
// one to those who only need to stand on it.
//
// Threads: those that the function itself allows.
#pragma once

#include <functional>

namespace belvedere {

using GroundHeight = std::function<double(double latitude_deg, double longitude_deg)>;

}  // namespace belvedere

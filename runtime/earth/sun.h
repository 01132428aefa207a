// Sun: where it stands, as a direction from the Earth.
//
// Source: the low-precision formulas of the Astronomical Almanac (section C, "Sun"): good to 0.01 degrees of arc
// between 1950 and 2050. UT1 is taken to be UTC (they differ by less than a second, 0.004 degrees of turn). Parallax
// (9") and refraction are left out: this lights the ground, it does not navigate by it.
//
// Units:   seconds since 1970-01-01 UTC. Frames: unit vector in ECEF.
// Threads: pure function.
#pragma once

#include <glm/vec3.hpp>

namespace belvedere {

glm::dvec3 SunDirectionEcef(double utc_s);

}  // namespace belvedere

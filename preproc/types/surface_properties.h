// Surface properties of heights, at every post of a page: what the stock modules make (process_modules.h).
//
// All look at the 3 x 3 posts around each. The outermost ring of the apron, whose neighbours the page has not, has the
// values of the ring within. Distances are those of the ellipsoid. Where a property does not fit its byte it has the
// nearest that does.
//
// Units: metres; slopes are rise over run. Threads: pure functions.
#pragma once

#include "runtime/earth/geoid.h"
#include "runtime/paging/page.h"

#include <memory>

namespace belvedere {

inline constexpr double kSlopeSteps_deg = 2;    // a degree
inline constexpr double kRoughnessSteps_m = 4;  // a metre

// Steepness, half a degree a step. Level ground is 0, a wall 180.
std::shared_ptr<PropertyPage> SlopeAngles(const ElevationPage& page, Quadcode node);
// East, north and up of the unit normal in the level frame of each post, three channels of -1 to 1 as 0 to 255.
std::shared_ptr<PropertyPage> NormalMap(const ElevationPage& page, Quadcode node);
// Standard deviation of the 9 heights from the plane that fits them best, a quarter of a metre a step.
std::shared_ptr<PropertyPage> Roughness(const ElevationPage& page, Quadcode node);
// 1 where the ground, and on the mean that around it, is not above mean sea level, 0 elsewhere.
std::shared_ptr<PropertyPage> WaterMask(const ElevationPage& page, Quadcode node, const Geoid& sea);

}  // namespace belvedere

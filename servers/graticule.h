// Graticule: a transparent image of lines of latitude and longitude, with one of each named on every page where one
// passes.
//
// The step depends on the level only: 15 10 5 2 1 degrees, then 30 20 10 5 2 1 minutes, seconds likewise, and tenths
// and hundredths of seconds, 1 2 or 5: at least a quarter of the quadnode's side. The equator and the meridians of 0
// and 180 degrees are heavier. Lines are exact to a hundredth of a texel. Poles have no line: the whole row would be
// one.
//
// Units: a step is a whole number of hundredths of a second.
// Threads: pure.
#pragma once

#include "runtime/earth/quadcode.h"
#include "servers/page_text.h"

#include <cstdint>
#include <memory>
#include <string>

namespace belvedere {

inline constexpr int64_t kGridUnitsPerDegree = 360'000;

int64_t GridStep(int level);
// "46\xB0" "30'N", in Latin-1, as finely as the step needs. value: in the step's units; longitudes of any turn.
std::string CoordinateName(int64_t value, int64_t step, bool is_latitude);

// RGBA; all mip levels are filled.
std::unique_ptr<ImagePage> DrawGraticule(Quadcode node, const PageText& text);

}  // namespace belvedere

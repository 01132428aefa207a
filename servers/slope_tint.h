// Slope tint: an image that colours the ground by how steep it is: pale grey-green for level ground, over green at 5,
// yellow at 10, orange at 20 and red at 30 degrees, to dark purple at 40 degrees and more, with no steps between.
//
// Slopes are true: rise over run in metres, as ShadeRelief takes them, but never raised. So coarse levels, whose posts
// lie kilometres apart, look gentler than the ground is; ground under the sea counts like any other.
//
// Threads: pure.
#pragma once

#include "runtime/paging/page.h"

#include <memory>

namespace belvedere {

// Opaque RGBA; all mip levels are filled.
std::unique_ptr<ImagePage> TintSlopes(const ElevationPage& heights, Quadcode node);

}  // namespace belvedere

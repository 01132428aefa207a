// Mip levels: fills levels 1 and 2 of an image page from its level 0.
//
// Each texel is the mean of the four under it, so a level covers the same ground as the one before and the gutter of 4
// texels becomes 2, then 1. Means are taken of the stored values, as the dataset's own coarser levels are, so that a
// mip level and the coarser quadnode look alike. Colours count by their alpha: what is transparent lends none.
//
// Threads: pure.
#pragma once

#include "runtime/paging/page.h"

namespace belvedere {

// REQUIRES: texels has the size of all levels.
void FillMipLevels(ImagePage& page);

// The GPU filters straight alpha, colour apart from alpha. So at every level a transparent texel beside others that are
// not takes on their mean colour, transparent still; else the rim of an overlay would be drawn half as bright.
// REQUIRES: kRGBA8, and the levels are filled.
void ColourRims(ImagePage& page);

}  // namespace belvedere

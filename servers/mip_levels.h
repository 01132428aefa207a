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

}  // namespace belvedere

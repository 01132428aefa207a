// Property tint: an image of a surface property. Classes have their colours; a number of one channel is a grey, dark
// for the lowest byte; three channels are red, green and blue, as normal maps are looked at.
//
// Classes are those of the nearest post, with no blend between; numbers are bilinear between posts.
//
// Threads: pure.
#pragma once

#include "runtime/paging/dataset.h"
#include "runtime/paging/page.h"

#include <memory>

namespace belvedere {

// All mip levels are filled. A byte that has no class is transparent.
std::unique_ptr<ImagePage> TintProperty(const PropertyPage& page, const PropertyRecord& meaning);

}  // namespace belvedere

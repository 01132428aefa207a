// Image modules: the read modules of image layers that are made here, of heights or of the quadnode alone. What each
// draws is told in its own header.
//
// Those of heights have pages where the elevation layer has; the others where the terrain has.
//
// Threads: at start, by one thread.
#pragma once

#include "servers/read_module.h"

#include <vector>

namespace belvedere {

// REQUIRES: elevation is registered, so that it has its data type.
std::vector<ReadModule> ModulesOfHeights(const ReadModule& elevation);
std::vector<ReadModule> ModulesOfQuadnodes(const ReadModule& terrain);

}  // namespace belvedere

// Model detail: the coarser levels of a model's mesh.
//
// Threads: pure.
#pragma once

#include "runtime/paging/page.h"

namespace belvedere {

// Takes `indices` as the finest level, shares equal vertices, and appends coarser levels to indices and details.
// REQUIRES: vertices and indices are filled, details is empty.
void AddDetails(ModelPage& page);

}  // namespace belvedere

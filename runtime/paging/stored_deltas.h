// Stored deltas: delta values as an elevation page of the dataset has them, in the logarithm. What is restored promises
// no less than what was stored, and a sixteenth more at most, down to a two-millionth of the greatest.
//
// Units: metres. Threads: pure.
#pragma once

#include "runtime/paging/page.h"

#include <span>
#include <vector>

namespace belvedere {

// Both: kVerticesPerPage.
StoredDeltas StoreDeltas(std::span<const float> deltas_m);
std::vector<float> RestoreDeltas(const StoredDeltas& stored);

}  // namespace belvedere

// The order in which pages go to the GPU: every list's most wanted page, then every list's second, and so on, so that
// no view waits for another. The list that goes first changes with `turn`. Pages that are there already are left out,
// and a page that several views want comes once.
//
// Threads: pure function.
#pragma once

#include "runtime/paging/shared_cache.h"

#include <cstddef>
#include <span>
#include <vector>

namespace belvedere {

// wishes: one span a list, most wanted first.
std::vector<const PagePin*> FairUploadOrder(std::span<const std::span<const PagePin>> wishes, size_t turn);

}  // namespace belvedere

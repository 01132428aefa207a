// Page network: the modules of a data type, joined as its declaration says, with pages flowing through.
//
//   source -> limit -> read -> module -> module -> .. -> write
//                ^                                         |
//                +-----------------------------------------+
//
// The source, one page at a time, fetches a page's bytes; reading decodes them, modules process, and writing encodes,
// all of it for many pages at once but for modules that are used in series; what puts pages into the dataset runs one
// at a time. So many pages are under way at most. An edge of oneTBB's flow graph each.
//
// Threads: Run blocks the caller; modules run on the workers of the arena that it is called in.
#pragma once

#include "preproc/types/process_modules.h"
#include "runtime/base/status.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace belvedere {

inline constexpr int kMostPagesUnderWay = 64;

struct StoredPage {
  Quadcode node;
  std::vector<uint8_t> bytes;
};

struct NetworkEnds {
  // The next page of the parent layer, as stored; nothing after the last. Never called twice at once.
  std::function<std::optional<StoredPage>()> next;
  // One that is done. Never called twice at once.
  std::function<Status(const StoredPage&)> put;
};

// Sends all pages through. The first failure, with the quadnode and the module in its message, stops the flow.
// context: its `takes` is what the bytes of the parent's pages mean. REQUIRES: CheckModules is ok of the type.
Status RunNetwork(const DeclaredType& type, const ModuleContext& context, const NetworkEnds& ends);

}  // namespace belvedere

// Heap: how the C library's heap, which all of the process shares, treats large blocks.
//
// Threads: any; to be called once, before there are others that take large blocks.
#pragma once

namespace belvedere {

// Blocks over this are mapped by themselves from the call on, and go back to the system when they are freed, so that
// pages that come and go do not break up the heaps (docs/decisions/0009).
inline constexpr int kOwnMapping_bytes = 128 * 1024;
void MapLargeBlocksAlone();

}  // namespace belvedere

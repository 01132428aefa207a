// ViewId: the number of a view, given out by the UI thread and not used again while the program runs.
#pragma once

#include <cstdint>

namespace belvedere {

using ViewId = uint32_t;

}  // namespace belvedere

#include "runtime/base/heap.h"

#include <malloc.h>

namespace belvedere {

void MapLargeBlocksAlone() {
  mallopt(M_MMAP_THRESHOLD, kOwnMapping_bytes);  // which also keeps the threshold from growing
}

}  // namespace belvedere

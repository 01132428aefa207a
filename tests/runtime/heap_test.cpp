#include "runtime/base/heap.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>

namespace belvedere {
namespace {

// How many blocks with a mapping of their own one of that size adds.
long MappedBy(size_t bytes) {
  const size_t before = mallinfo2().hblks;
  void* volatile block = std::malloc(bytes);
  const size_t with = mallinfo2().hblks;
  std::free(block);
  return static_cast<long>(with - before);
}

constexpr size_t kMiB = size_t{1} << 20;

TEST(Heap, LargeBlocksStayMappedAloneAfterLargerOnesWereFreed) {
  if (MappedBy(16 * kMiB) == 0) GTEST_SKIP() << "a sanitizer's heap";
  ASSERT_EQ(MappedBy(kMiB), 0) << "freeing 16 MiB has raised the threshold";
  MapLargeBlocksAlone();
  // More than the heap has free now, from which it would be taken.
  EXPECT_EQ(MappedBy(4 * kMiB), 1);
  EXPECT_EQ(MappedBy(16 * kMiB), 1);
  EXPECT_EQ(MappedBy(4 * kMiB), 1) << "the threshold no longer grows";
  EXPECT_EQ(MappedBy(kOwnMapping_bytes / 2), 0);
}

}  // namespace
}  // namespace belvedere

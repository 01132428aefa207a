// BlockCache: blocks of the pixels of all sources of a build, and of their pyramids, within a number of bytes.
//
// Out goes first what was used least recently, but what is dear to make again stays for longer: a block's worth is what
// had been let go when it was last used plus its cost, and the least goes (Cao and Irani 1997, "Cost-aware WWW proxy
// caching algorithms", GreedyDual; blocks are nearly of one size). So the coarse levels of a pyramid, of which each
// block stands for much of a source, are made once.
//
// Units:   elevation in the source's metres; colours 8-bit RGB; costs in blocks of pixels that are read.
// Threads: all methods, any thread. Blocks are shared, and do not change.
#pragma once

#include "runtime/base/mutex.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace belvedere {

inline constexpr int kBlockSide = 256;

// Pixels row by row from the source's first line; those outside the source have coverage 0.
struct Block {
  std::vector<float> heights;     // elevation
  std::vector<uint8_t> colours;   // imagery, 3 a pixel
  std::vector<uint8_t> coverage;  // kBlockSide^2
  size_t bytes() const { return heights.size() * sizeof(float) + colours.size() + coverage.size(); }
};

class BlockCache {
 public:
  explicit BlockCache(size_t budget_bytes) : budget_bytes_(budget_bytes) {}
  // nullptr when it is not there.
  std::shared_ptr<const Block> Find(uint64_t key) EXCLUDES_LOCK(mutex_);
  // cost: how many blocks have to be read from the source to make it again.
  void Insert(uint64_t key, std::shared_ptr<const Block> block, double cost) EXCLUDES_LOCK(mutex_);

 private:
  struct Entry {
    std::shared_ptr<const Block> block;
    double cost = 1;
    double worth = 0;  // goes with the least first,
    uint64_t use = 0;  // and of equals the one used first
  };
  void Use(uint64_t key, Entry& entry) REQUIRES_LOCK(mutex_);

  const size_t budget_bytes_;
  Mutex mutex_;
  std::unordered_map<uint64_t, Entry> entries_ GUARDED_BY(mutex_);
  std::map<std::pair<double, uint64_t>, uint64_t> by_worth_ GUARDED_BY(mutex_);  // worth and use -> key
  double let_go_ GUARDED_BY(mutex_) = 0;                                         // worth of what went last
  uint64_t uses_ GUARDED_BY(mutex_) = 0;
  size_t bytes_ GUARDED_BY(mutex_) = 0;
};

}  // namespace belvedere

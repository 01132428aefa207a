// StoreMapping: the memory into which the system maps a dataset's store, and a way to give back what has been read of
// it.
//
// What is read through a mapping counts as the process's memory until the system wants it, so a station that flies over
// all of a dataset for a week would seem to grow to its size. GiveBack unmaps what was touched; it stays in the
// system's file cache, and is mapped again by whoever touches it next.
//
// Threads: any; readers may go on reading while another gives back.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace belvedere {

class StoreMapping {
 public:
  static constexpr size_t kMappedAtOnce = size_t{64}
                                          << 10;  // around a page that is touched, where the file is in its cache

  // inside: an address that the mapping holds. Where the system does not tell where it lies, GiveBack does nothing.
  void Find(const void* inside);
  void Forget() { begin_ = end_ = 0; }
  bool is_found() const { return begin_ != end_; }
  // Counts bytes that were read, and gives everything back when they have become many.
  void HaveRead(size_t bytes) const;
  void GiveBack() const;

 private:
  static constexpr size_t kKept = size_t{2} << 20;

  uintptr_t begin_ = 0, end_ = 0;
  mutable std::atomic<size_t> read_{0};
};

}  // namespace belvedere

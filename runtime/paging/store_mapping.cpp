#include "runtime/paging/store_mapping.h"

#include <sys/mman.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace belvedere {

void StoreMapping::Find(const void* inside) {
  const auto address = reinterpret_cast<uintptr_t>(inside);
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    char* rest = nullptr;
    const uintptr_t begin = std::strtoull(line.c_str(), &rest, 16);
    if (*rest != '-') continue;
    const uintptr_t end = std::strtoull(rest + 1, nullptr, 16);
    if (address < begin || address >= end) continue;
    begin_ = begin;
    end_ = end;
    return;
  }
}

void StoreMapping::HaveRead(size_t bytes) const {
  if (begin_ == end_) return;
  if (read_.fetch_add(bytes, std::memory_order_relaxed) + bytes < kKept) return;
  GiveBack();
}

void StoreMapping::GiveBack() const {
  if (begin_ == end_) return;
  read_.store(0, std::memory_order_relaxed);
  // Of a read-only mapping of a file nothing can be lost by this.
  madvise(reinterpret_cast<void*>(begin_), end_ - begin_, MADV_DONTNEED);
}

}  // namespace belvedere

// SlotPool: which page is in which slot of one pool of GPU memory, and which slot to use next. Policy only: no GL here.
//
// Slots are numbered from `first`, so that two pools may share one range of numbers and a number says which pool it is
// of. A slot is empty, or holds one page. Take finds a slot for another page: an empty one; else one whose page is gone
// from memory; else the one used longest ago that nobody pins and that was not used in the last kGraceFrames frames (a
// page that was just placed must live until its manager had time to pin it).
//
// Threads: the render thread's own; managers meet it in Residency only.
#pragma once

#include "runtime/paging/residency.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace belvedere {

class SlotPool {
 public:
  static constexpr uint64_t kGraceFrames = 30;

  explicit SlotPool(int slots, int first = 0) : first_(first), slots_(static_cast<size_t>(slots)) {}
  ~SlotPool();
  SlotPool(const SlotPool&) = delete;
  SlotPool& operator=(const SlotPool&) = delete;

  // An empty slot; nullopt when everything is in use (counted by refused()).
  std::optional<int> Take(uint64_t frame);
  // REQUIRES: slot came from Take, and its contents are on the GPU.
  void Fill(int slot, std::shared_ptr<Residency> residency, uint64_t frame);
  // A list that is drawn uses the slot.
  void Touch(int slot, uint64_t frame);

  bool Owns(int slot) const { return slot >= first_ && slot < first_ + size(); }
  int first() const { return first_; }
  int size() const { return static_cast<int>(slots_.size()); }
  int filled() const { return filled_; }
  uint64_t evicted() const { return evicted_; }
  uint64_t refused() const { return refused_; }

 private:
  struct Slot {
    std::shared_ptr<Residency> residency;  // null: empty
    uint64_t used = 0;                     // frame
  };
  bool Empty(Slot& slot);

  const int first_;
  std::vector<Slot> slots_;
  int filled_ = 0;
  uint64_t evicted_ = 0;
  uint64_t refused_ = 0;
};

}  // namespace belvedere

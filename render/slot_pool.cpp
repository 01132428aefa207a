#include "render/slot_pool.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <utility>

namespace belvedere {

// What managers may still pin is no longer anywhere.
SlotPool::~SlotPool() {
  for (Slot& slot : slots_) {
    if (slot.residency) slot.residency->TryEvict();
  }
}

bool SlotPool::Empty(Slot& slot) {
  if (!slot.residency->TryEvict()) return false;
  slot.residency.reset();
  --filled_;
  ++evicted_;
  return true;
}

std::optional<int> SlotPool::Take(uint64_t frame) {
  const auto number = [&](const Slot& slot) { return first_ + static_cast<int>(&slot - slots_.data()); };
  if (filled_ < size()) {
    const auto empty = std::find_if(slots_.begin(), slots_.end(), [](const Slot& slot) { return !slot.residency; });
    return number(*empty);
  }
  for (Slot& slot : slots_) {
    const bool page_is_gone = slot.residency.use_count() == 1;
    if (page_is_gone && Empty(slot)) return number(slot);
  }
  std::vector<Slot*> oldest_first;
  for (Slot& slot : slots_) {
    if (slot.used + kGraceFrames <= frame) oldest_first.push_back(&slot);
  }
  std::sort(oldest_first.begin(), oldest_first.end(),
            [](const Slot* a, const Slot* b) { return std::pair(a->used, a) < std::pair(b->used, b); });
  for (Slot* slot : oldest_first) {
    if (Empty(*slot)) return number(*slot);
  }
  ++refused_;
  return std::nullopt;
}

void SlotPool::Fill(int slot, std::shared_ptr<Residency> residency, uint64_t frame) {
  Slot& filled = slots_[static_cast<size_t>(slot - first_)];
  BELVEDERE_CHECK(!filled.residency);
  filled.residency = std::move(residency);
  filled.used = frame;
  ++filled_;
  filled.residency->Place(slot);
}

void SlotPool::Touch(int slot, uint64_t frame) {
  if (Owns(slot)) slots_[static_cast<size_t>(slot - first_)].used = frame;
}

}  // namespace belvedere

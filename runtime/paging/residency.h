// Residency: whether, and in which slot, the render thread holds a page on the GPU; and who still draws from there.
//
// A manager that wants to draw a page calls TryPin. If the page is on the GPU the pin succeeds, and the slot stays
// until Unpin; if not, the manager asks for it in its display list and draws the ancestor meanwhile. The render thread
// alone calls Place and TryEvict; TryEvict fails while any pin is held, so a slot named by a display list is always
// valid.
//
// Threads: TryPin, Unpin any; Place, TryEvict the render thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

namespace belvedere {

class Residency {
 public:
  // The slot, pinned; nullopt when the page is not on the GPU.
  std::optional<int> TryPin() {
    int64_t state = state_.load(std::memory_order_acquire);
    while (state >= 0) {
      if (state_.compare_exchange_weak(state, state + kOnePin, std::memory_order_acq_rel)) {
        return static_cast<int>(state & kSlotMask);
      }
    }
    return std::nullopt;
  }
  void Unpin() { state_.fetch_sub(kOnePin, std::memory_order_acq_rel); }

  void Place(int slot) { state_.store(slot, std::memory_order_release); }
  bool TryEvict() {
    int64_t state = state_.load(std::memory_order_acquire);
    if (state < 0) return false;
    int64_t unpinned = state & kSlotMask;
    return state_.compare_exchange_strong(unpinned, kNowhere, std::memory_order_acq_rel);
  }
  bool on_gpu() const { return state_.load(std::memory_order_acquire) >= 0; }

 private:
  static constexpr int64_t kNowhere = -1;
  static constexpr int64_t kSlotMask = 0xFFFFFFFF;
  static constexpr int64_t kOnePin = kSlotMask + 1;
  std::atomic<int64_t> state_{kNowhere};  // pins in the high half, slot in the low half
};

}  // namespace belvedere

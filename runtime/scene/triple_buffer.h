// TripleBuffer: hands the newest of a stream of values from one thread to another; neither ever waits.
//
// The producer fills back() and calls Publish; the consumer calls Fetch and reads front(). Values that the consumer was
// too slow to see are overwritten. The values are reused, so that their memory is too; a value keeps what the producer
// left in it until the producer clears it.
//
// A consumer that has to make ready for a value takes it in two steps: after Receive it reads coming(), and front() is
// as it was until Show. A fourth value is there for that.
//
// Threads: one producer, one consumer.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace belvedere {

template <typename T>
class TripleBuffer {
 public:
  // Producer.
  T& back() { return values_[back_]; }
  void Publish() {
    const uint8_t previous = middle_.exchange(static_cast<uint8_t>(back_ | kFresh), std::memory_order_acq_rel);
    back_ = previous & kIndex;
  }

  // Consumer. True when front() is now a newer value than before.
  bool Fetch() {
    if (!Receive()) return false;
    Show();
    return true;
  }
  // True when coming() is now a newer value than before.
  bool Receive() {
    if ((middle_.load(std::memory_order_acquire) & kFresh) == 0) return false;
    const uint8_t previous = middle_.exchange(coming_, std::memory_order_acq_rel);
    coming_ = previous & kIndex;
    return true;
  }
  // What is coming() becomes front().
  void Show() { std::swap(front_, coming_); }
  const T& coming() const { return values_[coming_]; }
  const T& front() const { return values_[front_]; }

 private:
  static constexpr uint8_t kIndex = 3;
  static constexpr uint8_t kFresh = 4;

  std::array<T, 4> values_{};
  uint8_t back_ = 0;  // producer's own
  std::atomic<uint8_t> middle_{1};
  uint8_t front_ = 2;  // consumer's own
  uint8_t coming_ = 3;
};

}  // namespace belvedere

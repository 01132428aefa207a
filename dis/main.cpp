// belvedere-dis: DIS packets from files and networks, and synthetic ones to them.
#include "dis/commands.h"
#include "runtime/base/log.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <functional>

namespace {

using belvedere::Status;
using namespace belvedere::dis;

using Chosen = std::function<Status()>;

void AddFileCommands(CLI::App& app, Chosen& chosen, DecodeCommand& decode, ResidualsCommand& residuals,
                     ExtrapolateCommand& extrapolate) {
  CLI::App* command =
      app.add_subcommand("decode", "print the PDUs of captures or raw datagrams, one JSON object a line");
  command->add_option("FILE", decode.files, "pcap files, or files of one datagram each")->required();
  command->callback([&] { chosen = [&] { return Decode(decode); }; });

  command = app.add_subcommand("residuals", "how far reports lie from the ones before them, dead-reckoned");
  command->add_option("FILE", residuals.files, "pcap files")->required();
  command->callback([&] { chosen = [&] { return PrintResiduals(residuals); }; });

  command = app.add_subcommand("extrapolate", "dead-reckon the states in a CSV file");
  command->add_option("VECTORS", extrapolate.file, "columns id, drm, x0 .. z0, psi0_rad .., vx .., ax .., wx .., dt_s")
      ->required();
  command->callback([&] { chosen = [&] { return ExtrapolateRows(extrapolate); }; });
}

void AddTraffic(CLI::App& app, Chosen& chosen, TrafficCommand& traffic) {
  CLI::App* command = app.add_subcommand("traffic", "send synthetic traffic");
  TrafficOptions& options = traffic.options.traffic;
  command->add_option("--to", traffic.to, "ADDR:PORT")->required();
  command->add_option("--entities", options.entities, "how many vehicles")->capture_default_str();
  command->add_option("--rate", options.rate_pdus_per_s, "PDUs a second; 0: as the standard's thresholds ask")
      ->capture_default_str();
  command->add_option("--seconds", traffic.seconds, "how long; 0: until interrupted")->check(CLI::NonNegativeNumber);
  command->add_option("--seed", options.seed, "the same seed sends the same bytes")->capture_default_str();
  command->add_option("--scenario", options.scenario, "sierra, storm, airways, convoy or dogfight")
      ->capture_default_str();
  command->add_option("--flights", options.flights,
                      "recorded flights (JSON of ADS-B, may be gzipped) instead of a scenario");
  command->add_option("--speed", options.speed, "recorded flights so many times as fast, up to 720")
      ->capture_default_str();
  command->add_option("--from", options.flights_from_s, "seconds into the recording, by its own time")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--application", options.application, "of the entities' ids")->capture_default_str();
  command->add_option("--exercise", options.exercise, "exercise number")->capture_default_str();
  command->add_option("--version-of-dis", options.version, "protocol version")
      ->check(CLI::Range(5, 7))
      ->capture_default_str();
  command->add_flag("--absolute", traffic.absolute_timestamps, "timestamps in UTC (then runs differ in their bytes)");
  command->add_option("--interface", traffic.options.interface_address, "IPv4 address that multicast leaves by");
  command->callback([&] { chosen = [&] { return SendTraffic(traffic); }; });
}

void AddListen(CLI::App& app, Chosen& chosen, ListenCommand& listen) {
  CLI::App* command = app.add_subcommand("listen", "receive, and count what came");
  command->add_option("ADDRESS", listen.listen, "ADDR:PORT")->required();
  command->add_option("--seconds", listen.seconds, "how long; 0: until interrupted")->check(CLI::NonNegativeNumber);
  command->add_option("--exercise", listen.exercise, "take only this exercise")->check(CLI::Range(0, 255));
  AdmissionOptions& admission = listen.options.intake.admission;
  command->add_option("--source", listen.sources, "take only from such an address or range (10.0.0.0/8), repeatable");
  command->add_flag("--refuse-strangers", admission.refuse_strangers,
                    "Remove, Stop and Start only from the host that reports the entity");
  command->add_flag("--refuse-absurd", admission.refuse_absurd, "refuse places that cannot be shown");
  command->add_option("--most-pdus", admission.pdus_per_s, "PDUs a second from one host; 0: any number");
  command->add_option("--most-new", admission.new_entities_per_s, "new entities a second from one host; 0: any number");
  command->add_option("--interface", listen.options.network.interface_address, "IPv4 address that joins a group");
  command
      ->add_option("--buffer", listen.options.network.receive_buffer_bytes, "receive buffer asked of the kernel, bytes")
      ->check(CLI::Range(4096, 1 << 30))
      ->capture_default_str();
  command->add_flag("--json", listen.json, "one JSON object");
  command->callback([&] { chosen = [&] { return Listen(listen); }; });
}

void AddRecordAndReplay(CLI::App& app, Chosen& chosen, RecordCommand& record, ReplayCommand& replay) {
  CLI::App* command = app.add_subcommand("record", "write what arrives to a capture file");
  command->add_option("--listen", record.listen, "ADDR:PORT")->required();
  command->add_option("--out", record.out, "pcap file")->required();
  command->add_option("--seconds", record.seconds, "how long; 0: until interrupted")->check(CLI::NonNegativeNumber);
  command->add_option("--interface", record.interface_address, "IPv4 address that joins a group");
  command->callback([&] { chosen = [&] { return Record(record); }; });

  command = app.add_subcommand("replay", "send the datagrams of a capture again, in its own time");
  command->add_option("FILE", replay.file, "pcap file")->required();
  command->add_option("--to", replay.to, "ADDR:PORT")->required();
  command->add_option("--speed", replay.speed, "times as fast")->check(CLI::PositiveNumber)->capture_default_str();
  command->add_flag("--loop", replay.loop, "again and again");
  command->add_flag("--control", replay.control, "obey lines of standard input: pause, go, step [N], speed X");
  command->add_flag("--paused", replay.paused, "stand before the first datagram; needs --control")->needs("--control");
  command->add_option("--interface", replay.interface_address, "IPv4 address that multicast leaves by");
  command->callback([&] { chosen = [&] { return Replay(replay); }; });
}

int Main(int argc, char** argv) {
  CLI::App app("belvedere-dis: DIS packets from files and networks, and synthetic ones to them");
  app.set_version_flag("--version", "belvedere-dis " BELVEDERE_VERSION " (" BELVEDERE_BUILD_TYPE ")");
  app.require_subcommand(1);
  Chosen chosen;
  DecodeCommand decode;
  ResidualsCommand residuals;
  ExtrapolateCommand extrapolate;
  TrafficCommand traffic;
  ListenCommand listen;
  RecordCommand record;
  ReplayCommand replay;
  AddFileCommands(app, chosen, decode, residuals, extrapolate);
  AddTraffic(app, chosen, traffic);
  AddListen(app, chosen, listen);
  AddRecordAndReplay(app, chosen, record, replay);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const Status status = chosen();
  if (status.ok()) return 0;
  belvedere::LogError("{}", status.message());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Main(argc, argv);
  } catch (const std::exception& error) {
    belvedere::LogError("belvedere-dis: {}", error.what());
    return 1;
  }
}

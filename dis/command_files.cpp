// decode, residuals and extrapolate: from files to standard output.
#include "dis/codec.h"
#include "dis/commands.h"
#include "dis/motion_rows.h"
#include "dis/pcap.h"
#include "dis/pdu_json.h"
#include "dis/residuals.h"
#include "runtime/base/log.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <utility>

namespace belvedere::dis {
namespace {

Status FlushOutput() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
  return Status::Error("standard output: cannot write: {}", std::strerror(errno));
}

// Calls `take` with the frame's number and each PDU of the files, until it gives false.
Status ForEachPdu(const std::vector<std::string>& files, const std::function<bool(uint64_t, const Pdu&)>& take) {
  uint64_t frames_before = 0;
  for (const std::string& file : files) {
    auto reader = PcapReader::Open(file);
    if (!reader.ok()) return reader.status();
    uint64_t last = frames_before;
    while (const auto datagram = reader->Next()) {
      last = frames_before + datagram->frame;
      DatagramReader pdus(datagram->bytes);
      for (Pdu pdu; pdus.Next(pdu);) {
        if (!take(last, pdu)) return FlushOutput();
      }
    }
    frames_before = last;
    if (reader->stepped_over() > 0) {
      LogInfo("{}: {} frames hold no whole UDP datagram", file, reader->stepped_over());
    }
    if (!reader->status().ok()) return reader->status();
  }
  return FlushOutput();
}

}  // namespace

Status Decode(const DecodeCommand& command) {
  return ForEachPdu(command.files, [](uint64_t frame, const Pdu& pdu) {
    fmt::print("{}\n", PduJson(frame, pdu));
    return std::ferror(stdout) == 0;
  });
}

Status PrintResiduals(const ResidualsCommand& command) {
  Residuals residuals;
  Status status = ForEachPdu(command.files, [&](uint64_t, const Pdu& pdu) {
    if (const auto* state = std::get_if<EntityState>(&pdu.body)) residuals.Add(*state, pdu.header.timestamp);
    return true;
  });
  if (!status.ok()) return status;
  nlohmann::ordered_json line = {{"entities", residuals.entities()}, {"reports", residuals.position_m().size()}};
  for (const auto& [name, values] :
       {std::pair("position_m", &residuals.position_m()), std::pair("turn_rad", &residuals.turn_rad())}) {
    line[name] = {{"p50", ValueAt(*values, 0.5)}, {"p95", ValueAt(*values, 0.95)}, {"max", ValueAt(*values, 1.0)}};
  }
  fmt::print("{}\n", line.dump());
  return FlushOutput();
}

Status ExtrapolateRows(const ExtrapolateCommand& command) {
  std::ifstream file(command.file);
  if (!file) return Status::Error("{}: cannot open: {}", command.file, std::strerror(errno));
  const auto rows = ParseMotionRows(file, command.file);
  if (!rows.ok()) return rows.status();
  fmt::print("id,x,y,z,psi_rad,theta_rad,phi_rad,vx,vy,vz\n");
  for (const MotionRow& row : *rows) {
    const KinematicState later = Extrapolate(row.state, row.dt_s);
    const glm::dvec3 &p = later.position_ecef, &v = later.velocity_mps;
    const EulerAngles& angles = later.orientation;
    fmt::print("{},{},{},{},{},{},{},{},{},{}\n", row.id, p.x, p.y, p.z, angles.psi_rad, angles.theta_rad,
               angles.phi_rad, v.x, v.y, v.z);
  }
  return FlushOutput();
}

}  // namespace belvedere::dis

// decode and extrapolate: from files to standard output.
#include "dis/codec.h"
#include "dis/commands.h"
#include "dis/motion_rows.h"
#include "dis/pcap.h"
#include "dis/pdu_json.h"
#include "runtime/base/log.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace belvedere::dis {
namespace {

Status FlushOutput() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
  return Status::Error("standard output: cannot write: {}", std::strerror(errno));
}

}  // namespace

Status Decode(const DecodeCommand& command) {
  uint64_t frames_before = 0;
  for (const std::string& file : command.files) {
    auto reader = PcapReader::Open(file);
    if (!reader.ok()) return reader.status();
    uint64_t last = frames_before;
    while (const auto datagram = reader->Next()) {
      last = frames_before + datagram->frame;
      DatagramReader pdus(datagram->bytes);
      for (Pdu pdu; pdus.Next(pdu);) {
        fmt::print("{}\n", PduJson(last, pdu));
        if (std::ferror(stdout)) return FlushOutput();
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

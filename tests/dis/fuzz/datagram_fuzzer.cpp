// libFuzzer target: any bytes as a datagram, through the codec, the object table and dead reckoning.
#include "dis/intake.h"
#include "dis/pcap.h"
#include "dis/pdu_json.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace belvedere;
  const std::span<const uint8_t> datagram(bytes, size);
  ObjectTable table({.capacity = 4});
  dis::Intake intake(table);
  intake.Take(datagram, {1.0, 1e9, {}});
  table.Tick(1.0);
  for (const ObjectRecord& record : table.Snapshot()->objects) {
    const Pose pose = PoseAt(record.kinematics, 60.0);
    if (!std::isfinite(pose.position_ecef.x + pose.position_ecef.y + pose.position_ecef.z)) std::abort();
    if (!std::isfinite(pose.ecef_from_body[0].x + pose.ecef_from_body[1].y + pose.ecef_from_body[2].z)) std::abort();
  }
  dis::DatagramReader reader(datagram);
  for (dis::Pdu pdu; reader.Next(pdu);) {
    if (dis::PduJson(1, pdu).find('\n') != std::string::npos) std::abort();
  }
  for (const uint32_t link_type : {1u, 101u}) dis::UdpPayload(datagram, link_type);
  return 0;
}

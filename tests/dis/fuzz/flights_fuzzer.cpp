// libFuzzer target: any bytes as a file of recorded flights; what is taken must be flyable.
#include "dis/adsb.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace belvedere;
  static const std::string kPath =
      (std::filesystem::temp_directory_path() / ("flights_fuzzer." + std::to_string(std::rand()))).string();
  {
    std::ofstream file(kPath, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  }
  const auto flights = dis::ReadFlights({kPath}, 10);
  if (!flights.ok()) return 0;
  for (const dis::Vehicle& vehicle : *flights) {
    const glm::dvec3 at = dis::TruePose(vehicle, vehicle.track->start_s() + 1).position_ecef;
    if (!std::isfinite(at.x + at.y + at.z)) std::abort();
  }
  return 0;
}

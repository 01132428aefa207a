#include "dis/timestamp.h"

#include <cmath>

namespace belvedere::dis {

uint32_t MakeTimestamp(double seconds, bool absolute) {
  const double past_hour_s = seconds - 3600.0 * std::floor(seconds / 3600.0);
  const auto units = static_cast<uint64_t>(std::llround(past_hour_s * (2147483648.0 / 3600.0)));
  return static_cast<uint32_t>((units & 0x7FFFFFFF) << 1) | (absolute ? 1u : 0u);
}

}  // namespace belvedere::dis

// Image files: PNG for pictures, OpenEXR for depths. Written beside their place and moved into it; the same pixels give
// the same bytes.
//
// Threads: any, one a file.
#pragma once

#include "runtime/base/status.h"

#include <cstdint>
#include <span>
#include <string>

namespace belvedere {

// rgb: 3 bytes a pixel, rows from the top. REQUIRES: rgb.size() == 3 * width * height
Status WritePng(const std::string& path, int width, int height, std::span<const uint8_t> rgb);
// One float channel, "Z". REQUIRES: depth.size() == width * height
Status WriteDepthExr(const std::string& path, int width, int height, std::span<const float> depth);

}  // namespace belvedere

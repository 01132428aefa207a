#include "render/image_file.h"

#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

namespace belvedere {
namespace {

// OpenImageIO knows a format by the ending of the name, so that of the temporary file is kept.
std::string TemporaryPath(const std::string& path, const char* ending) {
  return path + ".part" + ending;
}

Status WriteImage(const std::string& path, const char* ending, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                  const void* pixels) {
  const std::string temporary = TemporaryPath(path, ending);
  auto output = OIIO::ImageOutput::create(temporary);
  std::string reason;
  bool written = false;
  if (!output) {
    reason = OIIO::geterror();
  } else {
    written = output->open(temporary, spec) && output->write_image(type, pixels);
    written = output->close() && written;
    if (!written) reason = output->geterror();
  }
  std::error_code error;
  if (written) {
    std::filesystem::rename(temporary, path, error);
    if (!error) return {};
    reason = error.message();
  }
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  while (!reason.empty() && reason.back() == '\n') reason.pop_back();
  return Status::Error("{}: cannot write the picture: {}; check the folder and the space on the disk", path, reason);
}

}  // namespace

Status WritePng(const std::string& path, int width, int height, std::span<const uint8_t> rgb) {
  BELVEDERE_CHECK(rgb.size() == 3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("png:compressionLevel", 6);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return WriteImage(path, ".png", spec, OIIO::TypeDesc::UINT8, rgb.data());
}

Status WriteDepthExr(const std::string& path, int width, int height, std::span<const float> depth) {
  BELVEDERE_CHECK(depth.size() == static_cast<size_t>(width) * static_cast<size_t>(height));
  OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Z"};
  spec.attribute("compression", "zip");
  return WriteImage(path, ".exr", spec, OIIO::TypeDesc::FLOAT, depth.data());
}

}  // namespace belvedere

#include "preproc/picture.h"

#include "preproc/raster_reader.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

namespace belvedere {
namespace {

constexpr int kJpegQuality = 80;

DatasetHandle InMemory(const Picture& picture) {
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("MEM");
  if (driver == nullptr) return nullptr;
  DatasetHandle raster(driver->Create("", picture.width, picture.height, 3, GDT_Byte, nullptr));
  std::vector<uint8_t> rgb = picture.rgb;
  if (!raster || raster->RasterIO(GF_Write, 0, 0, picture.width, picture.height, rgb.data(), picture.width,
                                  picture.height, GDT_Byte, 3, nullptr, 3, 3 * picture.width, 1, nullptr) != CE_None) {
    return nullptr;
  }
  return raster;
}

std::string Base64(const GByte* bytes, vsi_l_offset count) {
  char* const text = CPLBase64Encode(static_cast<int>(count), bytes);
  std::string out = text;
  CPLFree(text);
  return out;
}

}  // namespace

std::string DataUri(const Picture& picture, PictureFormat format) {
  const bool jpeg = format == PictureFormat::kJpeg;
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(jpeg ? "JPEG" : "PNG");
  const DatasetHandle raster = InMemory(picture);
  if (driver == nullptr || !raster) return {};
  CPLStringList options;
  if (jpeg) options.SetNameValue("QUALITY", std::to_string(kJpegQuality).c_str());
  // A name of this picture's own, so that two threads may make pictures.
  const std::string path = fmt::format("/vsimem/belvedere_picture_{}", static_cast<const void*>(&picture));
  const bool written =
      DatasetHandle(driver->CreateCopy(path.c_str(), raster.get(), FALSE, options.List(), nullptr, nullptr)) != nullptr;
  vsi_l_offset count = 0;
  const GByte* const bytes = written ? VSIGetMemFileBuffer(path.c_str(), &count, FALSE) : nullptr;
  std::string uri;
  if (bytes != nullptr) uri = fmt::format("data:image/{};base64,{}", jpeg ? "jpeg" : "png", Base64(bytes, count));
  VSIUnlink(path.c_str());
  VSIUnlink((path + ".aux.xml").c_str());
  return uri;
}

}  // namespace belvedere

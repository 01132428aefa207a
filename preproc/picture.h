// Picture: a small picture in memory, and the same as a data URI to put into a page.
//
// Rows run from the north, or the top. sRGB, 3 bytes a pixel.
// Threads: values and pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace belvedere {

using Rgb = std::array<uint8_t, 3>;

struct Picture {
  Picture(int columns, int rows)
      : width(columns), height(rows), rgb(3 * static_cast<size_t>(columns) * static_cast<size_t>(rows)) {}

  void Set(int column, int row, const Rgb& colour) {
    for (size_t c = 0; c < 3; ++c) rgb[OffsetOf(column, row) + c] = colour[c];
  }
  Rgb At(int column, int row) const {
    const size_t offset = OffsetOf(column, row);
    return {rgb[offset], rgb[offset + 1], rgb[offset + 2]};
  }

  int width, height;
  std::vector<uint8_t> rgb;

 private:
  size_t OffsetOf(int column, int row) const {
    return 3 * (static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column));
  }
};

// JPEG for what is like a photograph, PNG for few colours with sharp borders. REQUIRES: GDALAllRegister was called.
// Empty when this GDAL cannot write the format.
enum class PictureFormat { kJpeg, kPng };
std::string DataUri(const Picture& picture, PictureFormat format);

}  // namespace belvedere

#include "preproc/source_path.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <utility>

namespace belvedere {
namespace {

constexpr double kMercatorSide_m = 20'037'508.342789244;  // half of the square of EPSG:3857

bool StartsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}
bool Contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}
bool IsUrl(std::string_view text) {
  return StartsWith(text, "http://") || StartsWith(text, "https://");
}

// The name of a driver of GDAL and a colon, at the start: NETCDF:file.nc:height.
bool HasPrefix(std::string_view text) {
  const size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon < 2) return false;
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_'; });
}

void ReplaceAll(std::string& text, std::string_view from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

// GDAL's description of tiles on a server ("WMS -- Web Map Services" in its raster drivers).
std::string TilesOf(std::string_view written, int zoom) {
  std::string url(written);
  for (const auto& [from, to] : std::array<std::pair<const char*, const char*>, 5>{
           {{"&", "&amp;"}, {"{z}", "${z}"}, {"{x}", "${x}"}, {"{y}", "${y}"}, {"{-y}", "${y}"}}}) {
    ReplaceAll(url, from, to);
  }
  return fmt::format(
      "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>{}</ServerUrl></Service>"
      "<DataWindow><UpperLeftX>-{}</UpperLeftX><UpperLeftY>{}</UpperLeftY><LowerRightX>{}</LowerRightX>"
      "<LowerRightY>-{}</LowerRightY><TileLevel>{}</TileLevel><TileCountX>1</TileCountX><TileCountY>1</TileCountY>"
      "<YOrigin>{}</YOrigin></DataWindow><Projection>EPSG:3857</Projection><BlockSizeX>256</BlockSizeX>"
      "<BlockSizeY>256</BlockSizeY><BandsCount>4</BandsCount><ZeroBlockHttpCodes>204,404</ZeroBlockHttpCodes>"
      "</GDAL_WMS>",
      url, kMercatorSide_m, kMercatorSide_m, kMercatorSide_m, kMercatorSide_m, zoom,
      Contains(written, "{-y}") ? "bottom" : "top");
}

}  // namespace

bool IsTileTemplate(std::string_view written) {
  return IsUrl(written) && Contains(written, "{z}") && Contains(written, "{x}") &&
         (Contains(written, "{y}") || Contains(written, "{-y}"));
}

std::string ResolveSourcePath(std::string_view written, const std::string& folder, std::optional<int> zoom) {
  if (IsTileTemplate(written)) return TilesOf(written, zoom.value_or(0));
  if (IsUrl(written)) return "/vsicurl/" + std::string(written);
  if (StartsWith(written, "/vsi") || StartsWith(written, "<") || HasPrefix(written)) return std::string(written);
  return (std::filesystem::path(folder) / written).string();
}

bool NamesServer(std::string_view path) {
  constexpr std::array<std::string_view, 10> kSigns = {"http://", "https://", "ftp://",   "/vsicurl",    "/vsis3",
                                                       "/vsigs",  "/vsiaz",   "/vsiadls", "/vsiwebhdfs", "/vsioss"};
  return std::any_of(kSigns.begin(), kSigns.end(), [&](std::string_view sign) { return Contains(path, sign); });
}

void KeepOffNetwork(bool off) {
  CPLSetConfigOption("GDAL_ENABLE_WMS_CACHE", "NO");  // it would be left in the folder that the program was called from
  // A name that no file on a server has: the one that may be opened.
  CPLSetConfigOption("CPL_VSIL_CURL_ALLOWED_FILENAME", off ? "/vsicurl/none" : nullptr);
  // What GDAL's other drivers ask servers for goes through a proxy that is not there.
  CPLSetConfigOption("GDAL_HTTP_PROXY", off ? "127.0.0.1:9" : nullptr);
  CPLSetConfigOption("GDAL_HTTPS_PROXY", off ? "127.0.0.1:9" : nullptr);
}

}  // namespace belvedere

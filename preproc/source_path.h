// Source path: what GDAL is to open where a spec writes `path`.
//
//   a file or folder                     relative to the spec's folder
//   http:// or https:// FILE             a file on a server, read in parts as they are needed (GDAL's /vsicurl/)
//   http(s)://..{z}..{x}..{y}..          tiles of the Web Mercator, EPSG:3857, 256 x 256 pixels; y counts from the
//   north,
//                                        {-y} from the south; the level `zoom` is what is read
//   PREFIX:.., /vsi../.., <XML>          as it is: WMS:, WMTS:, GPKG:, NETCDF:, /vsizip/, ..
//
// Nothing but such a path reaches out: where a spec has none, GDAL is kept off the network (KeepOffNetwork), whatever
// the files say that it reads. Tiles are kept nowhere but in memory.
//
// Threads: pure functions, but for KeepOffNetwork, which changes GDAL for the whole process.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace belvedere {

// folder: of the spec.
std::string ResolveSourcePath(std::string_view written, const std::string& folder, std::optional<int> zoom);
// Whether it has places for a tile's level, column and row, and so needs a `zoom`.
bool IsTileTemplate(std::string_view written);
// Whether the path, as resolved, names a server.
bool NamesServer(std::string_view path);
// off: GDAL opens nothing that is not on this machine; else it may again.
void KeepOffNetwork(bool off);

}  // namespace belvedere

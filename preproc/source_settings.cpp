#include "preproc/source_settings.h"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace belvedere {
namespace {

using nlohmann::json;

// Names of GDAL's own, as "/vsizip/a.zip", are absolute; others may mean a file or not ("WMTS:https://...").
std::string AbsolutePath(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return path;
  const auto absolute = std::filesystem::weakly_canonical(path, error);
  return error ? path : absolute.string();
}

template <typename Value>
void PutIf(json& out, const char* key, const std::optional<Value>& value) {
  if (value) out[key] = *value;
}
template <typename Value>
void GetIf(const json& in, const char* key, std::optional<Value>& value) {
  if (in.contains(key)) value = in.at(key).get<Value>();
}

}  // namespace

std::string SettingsToJson(const SourceSpec& source) {
  // All members by name: who adds one is told here that datasets must keep it.
  const auto& [path, written_path, nodata, crs, box, geotransform, metres_per_unit, datum, datum_m, feather_m, utc_s,
               match_colour] = source;
  json out = {{"file", AbsolutePath(path)}, {"path", written_path}, {"datum", static_cast<int>(datum)}};
  PutIf(out, "nodata", nodata);
  PutIf(out, "crs", crs);
  if (box) out["box"] = {box->west_deg, box->south_deg, box->east_deg, box->north_deg};
  PutIf(out, "geotransform", geotransform);
  PutIf(out, "metres_per_unit", metres_per_unit);
  if (datum_m != 0) out["datum_m"] = datum_m;
  if (feather_m != 0) out["feather_m"] = feather_m;
  PutIf(out, "utc_s", utc_s);
  if (match_colour) out["match_colour"] = true;
  return out.dump();
}

Result<SourceSpec> SettingsFromJson(std::string_view text) {
  try {
    const json in = json::parse(text);
    SourceSpec source;
    source.path = in.at("file").get<std::string>();
    source.written_path = in.at("path").get<std::string>();
    source.datum = static_cast<VerticalDatum>(in.at("datum").get<int>());
    GetIf(in, "nodata", source.nodata);
    GetIf(in, "crs", source.crs);
    if (in.contains("box")) {
      const auto edges = in.at("box").get<std::array<double, 4>>();
      source.box = GeoBox{edges[0], edges[1], edges[2], edges[3]};
    }
    GetIf(in, "geotransform", source.geotransform);
    GetIf(in, "metres_per_unit", source.metres_per_unit);
    source.datum_m = in.value("datum_m", 0.0);
    source.feather_m = in.value("feather_m", 0.0);
    GetIf(in, "utc_s", source.utc_s);
    source.match_colour = in.value("match_colour", false);
    return source;
  } catch (const std::exception& problem) {
    return Status::Error("a source's settings are damaged ({})", problem.what());
  }
}

std::string StateOfFiles(const std::vector<std::string>& paths) {
  std::string state;
  for (const std::string& path : paths) {
    const std::string name = std::filesystem::path(path).filename().string();
    struct stat found {};
    VSIStatBufL virtual_found{};
    if (stat(path.c_str(), &found) == 0) {
      state += fmt::format("{} {} {}.{:09}\n", name, found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec);
    } else if (VSIStatL(path.c_str(), &virtual_found) == 0) {
      state += fmt::format("{} {} {}\n", name, virtual_found.st_size, virtual_found.st_mtime);
    } else {
      state += fmt::format("{} is not there\n", name);
    }
  }
  return state;
}

}  // namespace belvedere

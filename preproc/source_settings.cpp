#include "preproc/source_settings.h"

#include "preproc/mosaic.h"
#include "runtime/paging/page_codec.h"

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
  if (!std::filesystem::exists(path, error) && !IsPattern(path)) return path;
  const auto absolute = std::filesystem::weakly_canonical(path, error);
  return error ? path : absolute.string();
}

std::array<double, 4> Edges(const GeoBox& box) {
  return {box.west_deg, box.south_deg, box.east_deg, box.north_deg};
}
GeoBox BoxOf(const json& edges) {
  const auto numbers = edges.get<std::array<double, 4>>();
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

template <typename Value>
void PutIf(json& out, const char* key, const std::optional<Value>& value) {
  if (value) out[key] = *value;
}
template <typename Value>
void GetIf(const json& in, const char* key, std::optional<Value>& value) {
  if (in.contains(key)) value = in.at(key).get<Value>();
}

json SelectionToJson(const FeatureSelection& selection) {
  const auto& [of, table, where, importance, resolution_m, fields, corrects, width_m] = selection;
  json out = {{"class", FeatureClassName(of)}, {"resolution_m", resolution_m}};
  for (const auto& [key, text] : {std::pair<const char*, const std::string&>{"table", table},
                                  {"where", where},
                                  {"importance", importance},
                                  {"corrects", corrects}}) {
    if (!text.empty()) out[key] = text;
  }
  if (!fields.empty()) out["fields"] = fields;
  if (width_m > 0) out["width_m"] = width_m;
  return out;
}

FeatureSelection SelectionFromJson(const json& in) {
  FeatureSelection selection;
  selection.of = FeatureClassOf(in.at("class").get<std::string>()).value_or(FeatureClass::kOther);
  selection.resolution_m = in.at("resolution_m").get<double>();
  selection.table = in.value("table", "");
  selection.where = in.value("where", "");
  selection.importance = in.value("importance", "");
  selection.corrects = in.value("corrects", "");
  selection.width_m = in.value("width_m", 0.0);
  if (in.contains("fields")) selection.fields = in.at("fields").get<std::map<std::string, std::string>>();
  return selection;
}

}  // namespace

std::string SettingsToJson(const SourceSpec& source) {
  // All members by name: who adds one is told here that datasets must keep it. Files are found anew.
  const auto& [path, written_path, files, tiles, extent, nodata, crs, box, geotransform, metres_per_unit, datum,
               datum_m, datum_grid, feather_m, utc_s, match_colour, features] = source;
  json out = {{"file", AbsolutePath(path)}, {"path", written_path}, {"datum", static_cast<int>(datum)}};
  PutIf(out, "nodata", nodata);
  PutIf(out, "crs", crs);
  if (extent) out["extent"] = Edges(*extent);
  if (box) out["box"] = Edges(*box);
  PutIf(out, "geotransform", geotransform);
  PutIf(out, "metres_per_unit", metres_per_unit);
  if (datum_m != 0) out["datum_m"] = datum_m;
  if (!datum_grid.empty()) out["datum_grid"] = AbsolutePath(datum_grid);
  if (feather_m != 0) out["feather_m"] = feather_m;
  PutIf(out, "utc_s", utc_s);
  if (match_colour) out["match_colour"] = true;
  if (!tiles.empty()) out["tiles"] = tiles;
  if (features) out["features"] = SelectionToJson(*features);
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
    if (in.contains("extent")) source.extent = BoxOf(in.at("extent"));
    if (in.contains("box")) source.box = BoxOf(in.at("box"));
    GetIf(in, "geotransform", source.geotransform);
    GetIf(in, "metres_per_unit", source.metres_per_unit);
    source.datum_m = in.value("datum_m", 0.0);
    source.datum_grid = in.value("datum_grid", "");
    source.feather_m = in.value("feather_m", 0.0);
    GetIf(in, "utc_s", source.utc_s);
    source.match_colour = in.value("match_colour", false);
    source.tiles = in.value("tiles", "");
    if (in.contains("features")) source.features = SelectionFromJson(in.at("features"));
    return source;
  } catch (const std::exception& problem) {
    return Status::Error("a source's settings are damaged ({})", problem.what());
  }
}

std::string StateOfFiles(const std::vector<std::string>& paths) {
  constexpr size_t kMostListed = 64;
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
  if (paths.size() <= kMostListed) return state;
  const auto* bytes = reinterpret_cast<const uint8_t*>(state.data());
  return fmt::format("{} files, {} bytes of names, sizes and times, CRC-32C {:08x}\n", paths.size(), state.size(),
                     Crc32c({bytes, state.size()}));
}

}  // namespace belvedere

#include "preproc/mosaic.h"

#include "preproc/gdal_errors.h"
#include "preproc/raster_reader.h"
#include "preproc/source_path.h"
#include "preproc/source_settings.h"

#include <fnmatch.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

namespace belvedere {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostFiles = 100000;  // that a folder or pattern may name
constexpr double kSameSize = 1e-6;     // relative
constexpr double kSamePlace = 0.05;    // of a pixel, that grids may be apart

bool HasWildcard(std::string_view text) {
  return text.find_first_of("*?[") != std::string_view::npos;
}

// What lies beside a raster and GDAL would take for one.
bool IsSidecar(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".ovr" || extension == ".msk" || extension == ".aux" || extension == ".rrd" ||
         path.filename().string().ends_with(".aux.xml") || path.filename().string().starts_with(".");
}

// Matches a path's folders and name against those of a pattern, `**` against any number of them.
bool Matches(const fs::path& path, const fs::path& pattern) {
  const std::vector<fs::path> names(path.begin(), path.end()), wanted(pattern.begin(), pattern.end());
  std::vector<bool> reached(names.size() + 1, false);  // whether that many names can match what was seen of the pattern
  reached[0] = true;
  for (const fs::path& part : wanted) {
    std::vector<bool> next(names.size() + 1, false);
    for (size_t i = 0; i <= names.size(); ++i) {
      if (!reached[i]) continue;
      if (part == "**") {
        std::fill(next.begin() + static_cast<std::ptrdiff_t>(i), next.end(), true);
      } else if (i < names.size() && fnmatch(part.c_str(), names[i].c_str(), FNM_PERIOD) == 0) {
        next[i + 1] = true;
      }
    }
    reached = std::move(next);
  }
  return reached.back();
}

// All below the folder, or what of it matches the pattern. Links to folders are not followed.
Status CollectFiles(const fs::path& folder, const fs::path* pattern, std::vector<std::string>& files) {
  const bool is_deep = pattern == nullptr || std::find(pattern->begin(), pattern->end(), "**") != pattern->end();
  const auto folders =
      is_deep ? 0 : std::distance(pattern->begin(), pattern->end()) - std::distance(folder.begin(), folder.end()) - 1;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error), end;
  for (; !error && entry != end; entry.increment(error)) {
    if (!is_deep && entry.depth() >= folders) entry.disable_recursion_pending();
    std::error_code none;
    if (!entry->is_regular_file(none) || IsSidecar(entry->path())) continue;
    if (pattern != nullptr && !Matches(entry->path(), *pattern)) continue;
    if (files.size() == kMostFiles) return Status::Error("it names more than {} files; divide them", kMostFiles);
    files.push_back(entry->path().string());
  }
  if (error) return Status::Error("the folder {} cannot be read ({})", folder.string(), error.message());
  return {};
}

// What pixels must have in common to lie in one source.
struct Grid {
  std::string content;  // CRS, bands, types, nodata, units, palettes
  std::string label;    // for people
  std::string unit;
  bool has_nodata = false, has_alpha = false;
  std::array<double, 6> affine{};
  bool is_north_up = false;

  bool Fits(const Grid& other) const {
    if (!is_north_up || !other.is_north_up || content != other.content) return false;
    for (const size_t axis : {size_t{1}, size_t{5}}) {
      if (std::abs(affine[axis] - other.affine[axis]) > kSameSize * std::abs(affine[axis])) return false;
      const double pixels = (other.affine[axis == 1 ? 0 : 3] - affine[axis == 1 ? 0 : 3]) / affine[axis];
      if (std::abs(pixels - std::round(pixels)) > kSamePlace) return false;
    }
    return true;
  }
};

std::string PaletteText(GDALRasterBand& band) {
  const GDALColorTable* table = band.GetColorTable();
  std::string text;
  for (int i = 0; table != nullptr && i < table->GetColorEntryCount(); ++i) {
    const GDALColorEntry* entry = table->GetColorEntry(i);
    text += fmt::format(" {} {} {} {}", entry->c1, entry->c2, entry->c3, entry->c4);
  }
  return text;
}

Grid GridOf(GDALDataset& dataset) {
  Grid grid;
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  char* wkt = nullptr;
  if (crs != nullptr && crs->exportToWkt(&wkt) == OGRERR_NONE) grid.content = wkt;
  CPLFree(wkt);
  grid.is_north_up = dataset.GetGeoTransform(grid.affine.data()) == CE_None && grid.affine[2] == 0 &&
                     grid.affine[4] == 0 && grid.affine[1] > 0 && grid.affine[5] < 0;
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    GDALRasterBand& band = *dataset.GetRasterBand(i);
    int has_nodata = 0;
    const double nodata = band.GetNoDataValue(&has_nodata);
    grid.has_nodata |= has_nodata != 0;
    grid.has_alpha |= band.GetColorInterpretation() == GCI_AlphaBand;
    const bool has_mask = (band.GetMaskFlags() & GMF_PER_DATASET) != 0;
    grid.content += fmt::format("|{} {} {} {} {} {} {}{}", static_cast<int>(band.GetRasterDataType()),
                                static_cast<int>(band.GetColorInterpretation()),
                                has_nodata != 0 ? fmt::format("{}", nodata) : "none", band.GetScale(), band.GetOffset(),
                                band.GetUnitType(), has_mask, PaletteText(band));
    if (i == 1) grid.unit = band.GetUnitType();
  }
  const char* authority = crs != nullptr ? crs->GetAuthorityCode(nullptr) : nullptr;
  grid.label = fmt::format("{}, {:.6g} x {:.6g}, {}",
                           authority != nullptr ? fmt::format("{}:{}", crs->GetAuthorityName(nullptr), authority)
                           : crs != nullptr     ? crs->GetName()
                                                : "no CRS",
                           grid.affine[1], std::abs(grid.affine[5]),
                           GDALGetDataTypeName(dataset.GetRasterBand(1)->GetRasterDataType()));
  return grid;
}

DatasetHandle OpenRaster(const std::string& path) {
  CPLErrorReset();
  return DatasetHandle(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
}

bool IsRaster(const std::string& path) {
  return GDALIdentifyDriverEx(path.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr;
}

struct Group {
  Grid grid;
  std::vector<std::string> files;
};

// Names of their own, the same whatever other groups there are, as long as none is alike.
std::vector<std::string> LabelsOf(const std::vector<Group>& groups, const std::string& pattern) {
  std::vector<std::string> labels;
  std::set<std::string> taken;
  for (const Group& group : groups) {
    std::string label = group.grid.label;
    if (!group.grid.is_north_up)
      label = fs::path(group.files[0]).lexically_relative(fs::path(pattern).parent_path()).string();
    for (int n = 2; !taken.insert(label).second; ++n) label = fmt::format("{}, {}", group.grid.label, n);
    labels.push_back(label);
  }
  return labels;
}

// As GDAL takes them; they live as long as the arguments.
std::vector<char*> PointersTo(std::vector<std::string>& arguments) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  return pointers;
}

Result<std::string> VirtualRaster(const SourceSpec& source) {
  const DatasetHandle first = OpenRaster(source.files[0]);
  if (!first || first->GetRasterCount() < 1)
    return Status::Error("{} cannot be opened ({})", source.files[0], LastGdalError());
  const Grid grid = GridOf(*first);
  std::vector<std::string> arguments = {"-resolution", "highest"};
  if (source.nodata) {
    const std::string nodata = fmt::format("{}", *source.nodata);
    arguments.insert(arguments.end(), {"-srcnodata", nodata, "-vrtnodata", nodata});
  } else if (!grid.has_nodata && !grid.has_alpha) {
    arguments.emplace_back("-addalpha");  // else what no file covers would be 0
  }
  std::vector<char*> pointers = PointersTo(arguments);
  std::vector<const char*> names;
  names.reserve(source.files.size() + 1);
  for (const std::string& file : source.files) names.push_back(file.c_str());
  names.push_back(nullptr);
  CPLErrorReset();
  GDALBuildVRTOptions* options = GDALBuildVRTOptionsNew(pointers.data(), nullptr);
  const DatasetHandle mosaic(GDALDataset::FromHandle(
      GDALBuildVRT("", static_cast<int>(source.files.size()), nullptr, names.data(), options, nullptr)));
  GDALBuildVRTOptionsFree(options);
  if (!mosaic || mosaic->GetRasterCount() < 1)
    return Status::Error("its files cannot be put together ({})", LastGdalError());
  mosaic->GetRasterBand(1)->SetUnitType(grid.unit.c_str());
  char** const xml = mosaic->GetMetadata("xml:VRT");
  if (xml == nullptr || xml[0] == nullptr) return Status::Error("its files cannot be put together");
  return std::string(xml[0]);
}

// The part of the whole that lies in the box.
Result<std::string> PartOf(const std::string& path, const GeoBox& box) {
  constexpr double kMercatorEdge_deg = 85.051128;  // no tiles lie beyond
  const DatasetHandle whole = OpenRaster(path);
  if (!whole) return Status::Error("it cannot be opened ({})", LastGdalError());
  std::vector<std::string> arguments = {"-of", "VRT", "-projwin_srs", "EPSG:4326", "-projwin"};
  for (const double edge : {box.west_deg, std::min(box.north_deg, kMercatorEdge_deg), box.east_deg,
                            std::max(box.south_deg, -kMercatorEdge_deg)})
    arguments.push_back(fmt::format("{}", edge));
  std::vector<char*> pointers = PointersTo(arguments);
  CPLErrorReset();
  GDALTranslateOptions* options = GDALTranslateOptionsNew(pointers.data(), nullptr);
  const DatasetHandle part(
      GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(whole.get()), options, nullptr)));
  GDALTranslateOptionsFree(options);
  char** const xml = part ? part->GetMetadata("xml:VRT") : nullptr;
  if (xml == nullptr || xml[0] == nullptr) return Status::Error("its extent cannot be read ({})", LastGdalError());
  return std::string(xml[0]);
}

// The same but for which of its files it has.
bool AreOfOnePattern(const SourceSpec& a, const SourceSpec& b) {
  SourceSpec other = b;
  other.tiles = a.tiles;
  return SettingsToJson(a) == SettingsToJson(other);
}

}  // namespace

bool IsPattern(const std::string& path) {
  if (path.empty() || path[0] == '<' || path.starts_with("/vsi") || NamesServer(path)) return false;
  std::error_code error;
  if (fs::is_directory(path, error)) return !IsRaster(path);
  return HasWildcard(path) && !fs::exists(path, error) && path.find(':') == std::string::npos;
}

Result<std::vector<std::string>> FilesOf(const std::string& written) {
  const std::string pattern = fs::path(written).lexically_normal().string();
  std::vector<std::string> files;
  std::error_code error;
  if (fs::is_directory(pattern, error)) {
    if (Status status = CollectFiles(pattern, nullptr, files); !status.ok()) return status;
  } else {
    fs::path folder;
    for (const fs::path& part : fs::path(pattern)) {
      if (HasWildcard(part.string())) break;
      folder /= part;
    }
    const fs::path walked = folder.empty() ? "." : folder;
    const fs::path wanted = folder.empty() ? "." / fs::path(pattern) : fs::path(pattern);
    if (!fs::is_directory(walked, error)) return Status::Error("there is no folder {}", walked.string());
    if (Status status = CollectFiles(walked, &wanted, files); !status.ok()) return status;
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<Mosaics> MosaicsOf(const SourceSpec& source) {
  if (source.box || source.geotransform)
    return Status::Error("a georeference is of one file, and this names many; give each a source of its own");
  const auto files = FilesOf(source.path);
  if (!files.ok()) return files.status();
  std::error_code error;
  const bool is_folder = fs::is_directory(source.path, error);
  Mosaics mosaics;
  std::vector<Group> groups;
  for (const std::string& file : *files) {
    if (is_folder && !IsRaster(file)) continue;  // a text beside them, or so
    const DatasetHandle dataset = OpenRaster(file);
    if (!dataset || dataset->GetRasterCount() < 1) {
      mosaics.unusable.push_back({file, fmt::format("it cannot be opened ({})", LastGdalError())});
      continue;
    }
    Grid grid = GridOf(*dataset);
    const auto found =
        std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.grid.Fits(grid); });
    if (found == groups.end())
      groups.push_back({std::move(grid), {file}});
    else
      found->files.push_back(file);
  }
  if (groups.empty() && mosaics.unusable.empty()) return Status::Error("no file of it is a raster that GDAL knows");
  if (groups.empty())
    return Status::Error("none of its files can be used; of {} {}", mosaics.unusable[0].path,
                         mosaics.unusable[0].reason);
  const std::vector<std::string> labels = LabelsOf(groups, source.path);
  for (size_t i = 0; i < groups.size(); ++i) {
    SourceSpec made = source;
    made.tiles = groups.size() > 1 ? labels[i] : "";
    made.files = std::move(groups[i].files);
    mosaics.sources.push_back(std::move(made));
  }
  return mosaics;
}

std::vector<UnusableFile> ExpandMosaics(BuildSpec& spec) {
  std::vector<UnusableFile> unusable;
  for (LayerSpec& layer : spec.layers) {
    std::vector<SourceSpec> expanded;
    for (size_t i = 0; i < layer.sources.size(); ++i) {
      SourceSpec& source = layer.sources[i];
      if (source.features || !IsPattern(source.path)) {
        expanded.push_back(std::move(source));
        continue;
      }
      while (i + 1 < layer.sources.size() && AreOfOnePattern(source, layer.sources[i + 1])) ++i;
      auto mosaics = MosaicsOf(source);
      if (!mosaics.ok()) {
        expanded.push_back(source);
        continue;
      }
      for (SourceSpec& made : mosaics->sources) expanded.push_back(std::move(made));
      for (UnusableFile& file : mosaics->unusable) {
        // A source without a time is in every step of a layer.
        const auto same = [&](const UnusableFile& other) { return other.path == file.path; };
        if (std::none_of(unusable.begin(), unusable.end(), same)) unusable.push_back(std::move(file));
      }
    }
    layer.sources = std::move(expanded);
  }
  return unusable;
}

Result<std::string> PathToOpen(const SourceSpec& source) {
  if (source.files.size() > 1) return VirtualRaster(source);
  if (source.files.size() == 1) return source.files[0];
  if (source.extent) return PartOf(source.path, *source.extent);
  if (!IsPattern(source.path)) return source.path;
  const auto mosaics = MosaicsOf(source);  // as ExpandMosaics tried: for the reason
  if (!mosaics.ok()) return mosaics.status();
  if (mosaics->sources.size() > 1) return Status::Error("its files do not fit together in one source");
  return PathToOpen(mosaics->sources[0]);
}

}  // namespace belvedere

#include "preproc/vertical_datum.h"

#include "preproc/gdal_errors.h"
#include "preproc/raster_reader.h"

#include <ogr_spatialref.h>
#include <proj.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

namespace belvedere {
namespace {

constexpr int kEgm96Height = 5773;  // EPSG
constexpr int kEllipsoidal = 2002;  // the type of a vertical datum, in WKT
constexpr int64_t kMostPosts = 40'000'000;
constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

std::string Text(const char* name) {
  return name != nullptr ? name : "";
}

// A grid as its file has it: row 0 is the northernmost, and posts lie at whole steps from the first.
struct GridFile {
  int columns = 0, rows = 0;
  double west_deg = 0, north_deg = 0, column_step_deg = 0, row_step_deg = 0;
  std::function<bool(int row, std::vector<float>& out)> read_row;
};

// What of the grid lies around the box.
Result<std::shared_ptr<const Geoid>> Cut(const GridFile& file, const GeoBox& box, const std::string& path) {
  const bool is_round = file.columns * file.column_step_deg > 360 - file.column_step_deg / 2;
  const int first_row =
      std::max(0, static_cast<int>(std::floor((file.north_deg - box.north_deg) / file.row_step_deg)) - 1);
  const int last_row =
      std::min(file.rows - 1, static_cast<int>(std::ceil((file.north_deg - box.south_deg) / file.row_step_deg)) + 1);
  const double turns = std::floor((box.west_deg - file.west_deg) / 360.0);
  const double west = (box.west_deg - file.west_deg - 360.0 * turns) / file.column_step_deg;
  int first_column = static_cast<int>(std::floor(west)) - 1;
  int columns = static_cast<int>(std::ceil((box.east_deg - box.west_deg) / file.column_step_deg)) + 4;
  const bool is_whole = is_round && columns >= file.columns;
  if (is_whole) {
    first_column = 0;
    columns = file.columns;
  } else if (!is_round) {
    const int end = std::min(first_column + columns, file.columns);
    first_column = std::max(first_column, 0);
    columns = end - first_column;
  }
  if (columns < 2 || last_row <= first_row) return Status::Error("{}: the grid does not reach the source", path);
  GeoidGrid grid;
  grid.path = path;
  grid.columns = columns;
  grid.rows = last_row - first_row + 1;
  if (int64_t{grid.columns} * grid.rows > kMostPosts)
    return Status::Error("{}: the source needs {} x {} of its posts, {} million at most; take a coarser grid", path,
                         grid.columns, grid.rows, kMostPosts / 1'000'000);
  grid.west_deg = file.west_deg + first_column * file.column_step_deg;
  grid.south_deg = file.north_deg - last_row * file.row_step_deg;
  grid.longitude_step_deg = file.column_step_deg;
  grid.latitude_step_deg = file.row_step_deg;
  grid.is_round = is_whole;
  std::vector<float> row(static_cast<size_t>(file.columns));
  for (int y = last_row; y >= first_row; --y) {
    if (!file.read_row(y, row)) return Status::Error("{}: the grid is cut short or damaged", path);
    for (int x = 0; x < columns; ++x)
      grid.heights_m.push_back(row[static_cast<size_t>((first_column + x + file.columns) % file.columns)]);
  }
  return Geoid::Of(std::move(grid));
}

// GeographicLib's geoids: a PGM of 16 bits with `# Offset` and `# Scale` in its comments, row 0 at the north pole,
// column 0 at Greenwich.
Result<std::shared_ptr<const Geoid>> LoadPgm(const std::string& path, const GeoBox& box) {
  auto file = std::make_shared<std::ifstream>(path, std::ios::binary);
  std::string line, sizes;
  double offset_m = 0, scale_m = 0;
  if (!std::getline(*file, line) || line != "P5") return Status::Error("{}: it is no geoid of GeographicLib's", path);
  int numbers[3] = {0, 0, 0};
  for (int found = 0; found < 3 && std::getline(*file, line);) {
    std::istringstream words(line);
    if (line.starts_with("#")) {
      std::string sign, key;
      words >> sign >> key;
      if (key == "Offset") words >> offset_m;
      if (key == "Scale") words >> scale_m;
      continue;
    }
    while (found < 3 && words >> numbers[found]) ++found;
  }
  const auto [width, height, largest] = numbers;
  constexpr int kLongestSide = 100000;
  if (width < 2 || height < 3 || width > kLongestSide || height > kLongestSide || largest != 65535 || !(scale_m > 0))
    return Status::Error("{}: it is no geoid of GeographicLib's: no Offset and Scale, or not of 16 bits", path);
  const std::streamoff start = file->tellg();
  GridFile grid{width, height, 0, 90, 360.0 / width, 180.0 / (height - 1), {}};
  grid.read_row = [=](int row, std::vector<float>& out) {
    std::vector<unsigned char> bytes(2 * static_cast<size_t>(width));
    file->seekg(start + std::streamoff{row} * static_cast<std::streamoff>(bytes.size()));
    if (!file->read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) return false;
    for (size_t i = 0; i < out.size(); ++i)
      out[i] = static_cast<float>(offset_m + scale_m * (bytes[2 * i] << 8 | bytes[2 * i + 1]));
    return true;
  };
  return Cut(grid, box, path);
}

Result<std::shared_ptr<const Geoid>> LoadRaster(const std::string& path, const GeoBox& box) {
  CPLErrorReset();
  const DatasetHandle dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset || dataset->GetRasterCount() < 1)
    return Status::Error("{}: the geoid grid cannot be opened ({})", path, LastGdalError());
  std::array<double, 6> affine{};
  const OGRSpatialReference* crs = dataset->GetSpatialRef();
  if (dataset->GetGeoTransform(affine.data()) != CE_None || affine[2] != 0 || affine[4] != 0 || !(affine[1] > 0) ||
      !(affine[5] < 0) || (crs != nullptr && !crs->IsGeographic()))
    return Status::Error("{}: a geoid grid must be in degrees, north up", path);
  GDALRasterBand* const band = dataset->GetRasterBand(1);
  int has_nodata = 0;
  const double nodata = band->GetNoDataValue(&has_nodata);
  GridFile grid{dataset->GetRasterXSize(),
                dataset->GetRasterYSize(),
                affine[0] + affine[1] / 2,
                affine[3] + affine[5] / 2,
                affine[1],
                -affine[5],
                {}};
  grid.read_row = [&](int row, std::vector<float>& out) {
    if (band->RasterIO(GF_Read, 0, row, grid.columns, 1, out.data(), grid.columns, 1, GDT_Float32, 0, 0, nullptr) !=
        CE_None)
      return false;
    for (float& value : out) {
      const bool is_missing = !std::isfinite(value) || (has_nodata != 0 && value == static_cast<float>(nodata));
      value = is_missing ? kMissing : static_cast<float>(value * band->GetScale() + band->GetOffset());
    }
    return true;
  };
  return Cut(grid, box, path);
}

// The file of the grid by which PROJ goes from the vertical CRS to the ellipsoid.
Result<std::string> GridOfVerticalCrs(const std::string& name) {
  const std::unique_ptr<PJ_CONTEXT, decltype(&proj_context_destroy)> context(proj_context_create(),
                                                                             &proj_context_destroy);
  const auto made = [](PJ* object) { return std::unique_ptr<PJ, decltype(&proj_destroy)>(object, &proj_destroy); };
  proj_log_level(context.get(), PJ_LOG_NONE);
  const auto vertical = made(proj_create(context.get(), name.c_str()));
  if (!vertical || proj_get_type(vertical.get()) != PJ_TYPE_VERTICAL_CRS)
    return Status::Error("datum \"{}\" is no vertical CRS that PROJ knows", name);
  const auto from = made(proj_create(context.get(), ("EPSG:4326+" + name.substr(name.find(':') + 1)).c_str()));
  const auto to = made(proj_create(context.get(), "EPSG:4979"));
  const std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, decltype(&proj_operation_factory_context_destroy)> factory(
      proj_create_operation_factory_context(context.get(), nullptr), &proj_operation_factory_context_destroy);
  proj_operation_factory_context_set_grid_availability_use(context.get(), factory.get(),
                                                           PROJ_GRID_AVAILABILITY_IGNORED);
  proj_operation_factory_context_set_spatial_criterion(context.get(), factory.get(),
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  const std::unique_ptr<PJ_OBJ_LIST, decltype(&proj_list_destroy)> operations(
      from && to ? proj_create_operations(context.get(), from.get(), to.get(), factory.get()) : nullptr,
      &proj_list_destroy);
  std::vector<std::string> wanted;
  for (int i = 0; operations && i < proj_list_get_count(operations.get()); ++i) {
    const auto operation = made(proj_list_get(context.get(), operations.get(), i));
    if (proj_coordoperation_get_grid_used_count(context.get(), operation.get()) != 1) continue;
    const char *short_name = nullptr, *full_name = nullptr;
    int is_available = 0;
    proj_coordoperation_get_grid_used(context.get(), operation.get(), 0, &short_name, &full_name, nullptr, nullptr,
                                      nullptr, nullptr, &is_available);
    if (is_available != 0 && !Text(full_name).empty()) return std::string(full_name);
    wanted.push_back(Text(short_name));
  }
  if (wanted.empty()) return Status::Error("PROJ knows no grid for the datum \"{}\"", name);
  const std::string others = wanted.size() == 1 ? "" : fmt::format(", or one of {} others,", wanted.size() - 1);
  return Status::Error("PROJ's grid for the datum \"{}\" is not on this machine; put {}{} into one of PROJ's folders",
                       name, wanted[0], others);
}

}  // namespace

DeclaredHeights HeightsDeclaredBy(const OGRSpatialReference& crs) {
  DeclaredHeights heights;
  const OGR_SRSNode* const vertical = crs.GetAttrNode("VERT_CS");
  if (vertical == nullptr || vertical->GetChildCount() == 0) {
    if (crs.GetAxesCount() == 3) heights.datum = VerticalDatum::kEllipsoid;
    return heights;
  }
  heights.name = vertical->GetChild(0)->GetValue();
  const double metres = crs.GetTargetLinearUnits("VERT_CS");
  if (metres > 0 && metres != 1.0) heights.metres_per_unit = metres;
  const OGR_SRSNode* const datum = crs.GetAttrNode("VERT_DATUM");
  const char* const code = crs.GetAuthorityCode("VERT_CS");
  const bool is_ellipsoidal =
      datum != nullptr && datum->GetChildCount() > 1 && std::atoi(datum->GetChild(1)->GetValue()) == kEllipsoidal;
  if (is_ellipsoidal) {
    heights.datum = VerticalDatum::kEllipsoid;
  } else if (code != nullptr && std::atoi(code) == kEgm96Height) {
    heights.datum = VerticalDatum::kEgm96;
  } else if (code != nullptr && Text(crs.GetAuthorityName("VERT_CS")) == "EPSG") {
    heights.datum = VerticalDatum::kGrid;
    heights.grid = std::string("EPSG:") + code;
  }
  return heights;
}

Result<std::shared_ptr<const Geoid>> LoadGeoidGrid(const std::string& name, const GeoBox& box) {
  if (name.starts_with("EPSG:")) {
    const auto path = GridOfVerticalCrs(name);
    if (!path.ok()) return path.status();
    return LoadRaster(*path, box);
  }
  return name.ends_with(".pgm") ? LoadPgm(name, box) : LoadRaster(name, box);
}

}  // namespace belvedere

#include "runtime/earth/geoid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

namespace belvedere {
namespace {

constexpr int kLongestSide = 100000;
constexpr float kNodata = -88.8888f;
constexpr double kBeyond = 1e-6;  // of a step, that rounding may lead over the border
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

uint32_t BigEndian32(const char* bytes) {
  uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes[i]);
  return value;
}
double BigEndianDouble(const char* bytes) {
  return std::bit_cast<double>(static_cast<uint64_t>(BigEndian32(bytes)) << 32 | BigEndian32(bytes + 4));
}

std::vector<std::string> SearchFolders() {
  std::vector<std::string> folders;
  for (const char* name : {"PROJ_DATA", "PROJ_LIB"}) {
    const char* value = std::getenv(name);
    std::istringstream parts(value != nullptr ? value : "");
    for (std::string part; std::getline(parts, part, ':');) folders.push_back(part);
  }
  folders.insert(folders.end(), {"/usr/local/share/proj", "/usr/share/proj"});
  return folders;
}

}  // namespace

Result<std::shared_ptr<const Geoid>> Geoid::Load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 40> header{};
  if (!file.read(header.data(), header.size())) return Status::Error("{}: cannot read the geoid grid", path);
  GeoidGrid grid;
  grid.path = path;
  grid.south_deg = BigEndianDouble(&header[0]);
  grid.west_deg = BigEndianDouble(&header[8]);
  grid.latitude_step_deg = BigEndianDouble(&header[16]);
  grid.longitude_step_deg = BigEndianDouble(&header[24]);
  grid.rows = static_cast<int>(BigEndian32(&header[32]));
  grid.columns = static_cast<int>(BigEndian32(&header[36]));
  const auto sane = [](int side) { return side >= 2 && side <= kLongestSide; };
  if (!sane(grid.rows) || !sane(grid.columns) || !(grid.latitude_step_deg > 0) || !(grid.longitude_step_deg > 0)) {
    return Status::Error("{}: not a .gtx geoid grid", path);
  }
  const size_t count = static_cast<size_t>(grid.rows) * static_cast<size_t>(grid.columns);
  std::vector<char> bytes(4 * count);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    return Status::Error("{}: the geoid grid is cut short", path);
  }
  grid.heights_m.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const float height_m = std::bit_cast<float>(BigEndian32(&bytes[4 * i]));
    grid.heights_m[i] = height_m == kNodata || !std::isfinite(height_m) ? 0.0f : height_m;
  }
  return Of(std::move(grid));
}

std::shared_ptr<const Geoid> Geoid::Of(GeoidGrid grid) {
  auto geoid = std::make_shared<Geoid>();
  geoid->grid_ = std::move(grid);
  return geoid;
}

Result<std::shared_ptr<const Geoid>> Geoid::LoadEgm96() {
  for (const std::string& folder : SearchFolders()) {
    const std::string path = folder + "/egm96_15.gtx";
    if (std::ifstream(path).good()) return Load(path);
  }
  return Status::Error("egm96_15.gtx: the geoid grid is in none of PROJ's folders; install the package proj-data");
}

Geoid::Place Geoid::PlaceOfLatitude(double latitude_deg) const {
  const double last = grid_.rows - 1;
  const double rows = (latitude_deg - grid_.south_deg) / grid_.latitude_step_deg;
  const double y = std::clamp(rows, 0.0, last);
  const int row = std::min(static_cast<int>(y), grid_.rows - 2);
  const bool is_beyond = !grid_.is_round && std::abs(rows - y) > kBeyond;
  return {static_cast<size_t>(row), static_cast<size_t>(row) + 1, is_beyond ? kNone : y - row};
}

Geoid::Place Geoid::PlaceOfLongitude(double longitude_deg) const {
  double turns = (longitude_deg - grid_.west_deg) / 360.0;
  turns -= std::floor(turns);
  double x = turns * 360.0 / grid_.longitude_step_deg;
  if (!grid_.is_round) {
    const double last = grid_.columns - 1;
    const double round = 360.0 / grid_.longitude_step_deg;
    if (x > round - kBeyond) x = 0;
    if (x > last + kBeyond) return {0, 0, kNone};
    x = std::min(x, last);
    const int column = std::min(static_cast<int>(x), grid_.columns - 2);
    return {static_cast<size_t>(column), static_cast<size_t>(column) + 1, x - column};
  }
  const int column = std::min(static_cast<int>(x), grid_.columns - 1);
  const int next = column + 1 < grid_.columns ? column + 1 : 0;
  return {static_cast<size_t>(column), static_cast<size_t>(next), x - column};
}

double Geoid::Interpolate(const Place& row, const Place& column) const {
  const float* south = &grid_.heights_m[row.first * static_cast<size_t>(grid_.columns)];
  const float* north = &grid_.heights_m[row.second * static_cast<size_t>(grid_.columns)];
  const auto along = [&column](const float* line) {
    return static_cast<double>(line[column.first]) * (1 - column.fraction) +
           static_cast<double>(line[column.second]) * column.fraction;
  };
  return along(south) * (1 - row.fraction) + along(north) * row.fraction;
}

double Geoid::Height(double latitude_deg, double longitude_deg) const {
  return Interpolate(PlaceOfLatitude(latitude_deg), PlaceOfLongitude(longitude_deg));
}

std::vector<double> Geoid::Heights(std::span<const double> latitudes_deg,
                                   std::span<const double> longitudes_deg) const {
  std::vector<Place> columns;
  for (const double longitude_deg : longitudes_deg) columns.push_back(PlaceOfLongitude(longitude_deg));
  std::vector<double> heights_m;
  heights_m.reserve(latitudes_deg.size() * columns.size());
  for (const double latitude_deg : latitudes_deg) {
    const Place row = PlaceOfLatitude(latitude_deg);
    for (const Place& column : columns) heights_m.push_back(Interpolate(row, column));
  }
  return heights_m;
}

}  // namespace belvedere

#include "runtime/earth/geoid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace belvedere {
namespace {

constexpr int kLongestSide = 100000;
constexpr float kNodata = -88.8888f;

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
  auto geoid = std::make_shared<Geoid>();
  geoid->path_ = path;
  geoid->south_deg_ = BigEndianDouble(&header[0]);
  geoid->west_deg_ = BigEndianDouble(&header[8]);
  geoid->latitude_step_deg_ = BigEndianDouble(&header[16]);
  geoid->longitude_step_deg_ = BigEndianDouble(&header[24]);
  geoid->rows_ = static_cast<int>(BigEndian32(&header[32]));
  geoid->columns_ = static_cast<int>(BigEndian32(&header[36]));
  const auto sane = [](int side) { return side >= 2 && side <= kLongestSide; };
  if (!sane(geoid->rows_) || !sane(geoid->columns_) || !(geoid->latitude_step_deg_ > 0) ||
      !(geoid->longitude_step_deg_ > 0)) {
    return Status::Error("{}: not a .gtx geoid grid", path);
  }
  const size_t count = static_cast<size_t>(geoid->rows_) * static_cast<size_t>(geoid->columns_);
  std::vector<char> bytes(4 * count);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    return Status::Error("{}: the geoid grid is cut short", path);
  }
  geoid->heights_m_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const float height_m = std::bit_cast<float>(BigEndian32(&bytes[4 * i]));
    geoid->heights_m_[i] = height_m == kNodata || !std::isfinite(height_m) ? 0.0f : height_m;
  }
  return std::shared_ptr<const Geoid>(std::move(geoid));
}

Result<std::shared_ptr<const Geoid>> Geoid::LoadEgm96() {
  for (const std::string& folder : SearchFolders()) {
    const std::string path = folder + "/egm96_15.gtx";
    if (std::ifstream(path).good()) return Load(path);
  }
  return Status::Error("egm96_15.gtx: the geoid grid is in none of PROJ's folders; install the package proj-data");
}

Geoid::Place Geoid::PlaceOfLatitude(double latitude_deg) const {
  const double y = std::clamp((latitude_deg - south_deg_) / latitude_step_deg_, 0.0, static_cast<double>(rows_ - 1));
  const int row = std::min(static_cast<int>(y), rows_ - 2);
  return {static_cast<size_t>(row), static_cast<size_t>(row) + 1, y - row};
}

Geoid::Place Geoid::PlaceOfLongitude(double longitude_deg) const {
  double turns = (longitude_deg - west_deg_) / 360.0;
  turns -= std::floor(turns);
  const double x = turns * 360.0 / longitude_step_deg_;
  const int column = std::min(static_cast<int>(x), columns_ - 1);
  const int next = column + 1 < columns_ ? column + 1 : 0;  // a global grid closes on itself
  return {static_cast<size_t>(column), static_cast<size_t>(next), x - column};
}

double Geoid::Interpolate(const Place& row, const Place& column) const {
  const float* south = &heights_m_[row.first * static_cast<size_t>(columns_)];
  const float* north = &heights_m_[row.second * static_cast<size_t>(columns_)];
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

#include "dis/adsb.h"

#include "runtime/earth/ellipsoid.h"

#include <zlib.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace belvedere::dis {
namespace {

constexpr double kMetresPerFoot = 0.3048;
constexpr double kGap_s = 600.0;        // without a row: another flight
constexpr double kFastest_mps = 450.0;  // over the ground
constexpr size_t kFewestPlaces = 4;
constexpr size_t kMostBytes = size_t{1} << 30;
constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

struct Row {
  double time_s = kNotGiven, latitude_deg = kNotGiven, longitude_deg = kNotGiven, altitude_ft = kNotGiven;
  std::string icao24, callsign;
  bool is_good() const {
    return std::isfinite(time_s) && std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 360 &&
           altitude_ft > -2000 && altitude_ft < 100'000;
  }
};

// Takes the rows out of the text as it is parsed: nothing is kept of what is not asked for.
class RowReader final : public nlohmann::json_sax<nlohmann::json> {
 public:
  const std::vector<Row>& rows() const { return rows_; }
  const std::string& mistake() const { return mistake_; }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t value) override { return Number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return Number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return Number(value); }
  bool string(string_t& value) override {
    if (key_ == "icao24") row_.icao24 = value;
    if (key_ == "callsign") row_.callsign = value;
    return true;
  }
  bool binary(binary_t&) override { return true; }
  bool start_object(size_t) override {
    if (++depth_ == 1) row_ = {};
    return true;
  }
  bool key(string_t& value) override {
    key_ = depth_ == 1 ? value : std::string();
    return true;
  }
  bool end_object() override {
    if (--depth_ == 0 && row_.is_good()) rows_.push_back(std::move(row_));
    return true;
  }
  bool start_array(size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(size_t position, const std::string&, const nlohmann::json::exception& error) override {
    mistake_ = fmt::format("byte {}: {}", position, error.what());
    return false;
  }

 private:
  bool Number(double value) {
    if (key_ == "timestamp") row_.time_s = 1e-3 * value;
    if (key_ == "latitude") row_.latitude_deg = value;
    if (key_ == "longitude") row_.longitude_deg = value;
    if (key_ == "altitude") row_.altitude_ft = value;
    return true;
  }
  int depth_ = 0;  // of objects in objects: a row is one that is in none
  std::string key_, mistake_;
  Row row_;
  std::vector<Row> rows_;
};

Result<std::string> ReadWhole(const std::string& path) {
  const gzFile file = gzopen(path.c_str(), "rb");  // what is not gzipped comes as it is
  if (file == nullptr) return Status::Error("{}: cannot open: {}", path, std::strerror(errno));
  std::string text;
  std::vector<char> piece(size_t{1} << 20);
  int got = 0;
  while ((got = gzread(file, piece.data(), static_cast<unsigned>(piece.size()))) > 0 && text.size() < kMostBytes) {
    text.append(piece.data(), static_cast<size_t>(got));
  }
  int number = Z_OK;
  const std::string reason = got < 0 ? gzerror(file, &number) : "";
  const bool too_long = text.size() >= kMostBytes;
  gzclose(file);
  if (got < 0) return Status::Error("{}: cannot be unpacked: {}; get the file again", path, reason);
  if (too_long) return Status::Error("{}: more than {} MiB of text; cut it into several files", path, kMostBytes >> 20);
  return text;
}

using Flights = std::map<std::pair<std::string, std::string>, std::vector<Row>>;

Status ReadRows(const std::string& path, Flights& flights) {
  const Result<std::string> text = ReadWhole(path);
  if (!text.ok()) return text.status();
  RowReader reader;
  if (!nlohmann::json::sax_parse(*text, &reader)) {
    return Status::Error("{}: is not the JSON of recorded flights: {}", path, reader.mistake());
  }
  if (reader.rows().empty()) {
    return Status::Error("{}: no row has timestamp, latitude, longitude and altitude; is it a recording of flights?",
                         path);
  }
  for (const Row& row : reader.rows()) flights[{row.icao24, row.callsign}].push_back(row);
  return {};
}

// Mean over the five rows around.
double SmoothHeight(const std::vector<Row>& rows, size_t begin, size_t end, size_t index) {
  const size_t from = index >= begin + 2 ? index - 2 : begin, to = std::min(index + 3, end);
  double sum = 0;
  for (size_t i = from; i < to; ++i) sum += rows[i].altitude_ft;
  return kMetresPerFoot * sum / static_cast<double>(to - from);
}

std::vector<TrackPlace> PlacesOf(const std::vector<Row>& rows, size_t begin, size_t end, double zero_s, double speed) {
  std::vector<TrackPlace> places;
  for (size_t i = begin; i < end; ++i) {
    const glm::dvec3 here = ToEcef({rows[i].latitude_deg, rows[i].longitude_deg, SmoothHeight(rows, begin, end, i)});
    const double time_s = (rows[i].time_s - zero_s) / speed;
    if (!places.empty()) {
      const double step_s = time_s - places.back().time_s;
      if (step_s < 0.5 / speed) continue;
      if (glm::distance(here, places.back().position_ecef) > kFastest_mps * speed * step_s + 500) continue;
    }
    places.push_back({time_s, here});
  }
  return places;
}

// What a callsign says about what flies: air ambulances, registrations of small aircraft, flights of airlines.
Vehicle KindOf(const std::string& callsign) {
  constexpr uint16_t kUnitedStates = 225;
  const auto air = [](uint8_t category) { return EntityType{1, 2, kUnitedStates, category, 1, 0, 0}; };
  Vehicle vehicle;
  vehicle.model = DeadReckoning::kRvw;
  vehicle.appearance = uint32_t{3} << 13 | uint32_t{1} << 22;  // lights, power
  vehicle.marking = Marking::Sanitise(callsign);
  if (callsign.starts_with("REGA") || callsign.starts_with("SAMU")) {
    vehicle.type = air(21);
  } else if (callsign.find('-') != std::string::npos || callsign.size() < 5) {
    vehicle.type = air(85);
  } else {
    vehicle.type = air(57);
  }
  return vehicle;
}

}  // namespace

Result<std::vector<Vehicle>> ReadFlights(const std::vector<std::string>& files, double speed, double from_s) {
  Flights flights;
  for (const std::string& file : files) {
    if (Status status = ReadRows(file, flights); !status.ok()) return status;
  }
  double zero_s = HUGE_VAL;
  for (auto& [name, rows] : flights) {
    std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.time_s < b.time_s; });
    zero_s = std::min(zero_s, rows.front().time_s);
  }
  zero_s += from_s;
  std::vector<Vehicle> vehicles;
  for (const auto& [name, rows] : flights) {
    for (size_t begin = 0; begin < rows.size();) {
      size_t end = begin + 1;
      while (end < rows.size() && rows[end].time_s - rows[end - 1].time_s < kGap_s) ++end;
      std::vector<TrackPlace> places = PlacesOf(rows, begin, end, zero_s, speed);
      begin = end;
      if (places.size() < kFewestPlaces) continue;
      Vehicle& vehicle = vehicles.emplace_back(KindOf(name.second));
      vehicle.track = std::make_shared<const FlightTrack>(std::move(places), false);
      vehicle.time_scale = speed;
    }
  }
  if (vehicles.empty()) return Status::Error("{}: no flight of {} places or more", files.front(), kFewestPlaces);
  return vehicles;
}

}  // namespace belvedere::dis

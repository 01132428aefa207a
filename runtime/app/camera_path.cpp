#include "runtime/app/camera_path.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/scene/view_parameters.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace belvedere {
namespace {

constexpr std::string_view kHeader = "t_s,lat_deg,lon_deg,height_m,heading_deg,pitch_deg,roll_deg,vfov_deg";
constexpr size_t kColumns = 8;
constexpr size_t kMostRows = 1'000'000;
enum SeriesNumber { kNormalX, kNormalY, kNormalZ, kHeight, kHeading, kPitch, kRoll, kVfov };

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r' || text.back() == '\t')) text.remove_suffix(1);
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  return text;
}

std::optional<std::array<double, kColumns>> ParseRow(std::string_view line) {
  std::array<double, kColumns> row{};
  for (size_t column = 0; column < kColumns; ++column) {
    const size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (column + 1 == kColumns)) return std::nullopt;
    const std::string_view field = Trimmed(line.substr(0, comma));
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), row[column]);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(row[column])) return std::nullopt;
    if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
  }
  return row;
}

// What is out of range in a row, or empty.
std::string Complaint(const std::array<double, kColumns>& row) {
  if (std::abs(row[1]) > 90) return fmt::format("lat_deg {} is not in -90 .. 90", row[1]);
  if (std::abs(row[2]) > 360) return fmt::format("lon_deg {} is not in -360 .. 360", row[2]);
  if (row[3] < -12e3 || row[3] > 1e9) return fmt::format("height_m {} is not in -12000 .. 1e9", row[3]);
  if (std::abs(row[5]) > 90) return fmt::format("pitch_deg {} is not in -90 .. 90", row[5]);
  if (row[7] < 0.1 || row[7] > 170) return fmt::format("vfov_deg {} is not in 0.1 .. 170", row[7]);
  return {};
}

// The angle that differs from `degrees` by whole turns and is nearest to `previous`.
double Unwrapped(double degrees, double previous) {
  return previous + std::remainder(degrees - previous, 360.0);
}

}  // namespace

glm::dvec3 CameraPose::eye_ecef() const {
  return ToEcef(position);
}

glm::dmat3 CameraPose::ecef_from_camera() const {
  return CameraAxes(position.latitude_deg, position.longitude_deg, Radians::FromDegrees(heading_deg),
                    Radians::FromDegrees(pitch_deg), Radians::FromDegrees(roll_deg));
}

Result<CameraPath> CameraPath::Load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Status::Error("{}: cannot open the camera path; check the file name", path);
  std::ostringstream text;
  text << file.rdbuf();
  return Parse(text.str(), path);
}

Result<CameraPath> CameraPath::Parse(std::string_view text, const std::string& name) {
  CameraPath path;
  int line_number = 0;
  while (!text.empty()) {
    const size_t newline = text.find('\n');
    const std::string_view line = Trimmed(text.substr(0, newline));
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    if (++line_number == 1) {
      if (line != kHeader) return Status::Error("{}:1: the header must be {}", name, kHeader);
      continue;
    }
    if (line.empty()) continue;
    const auto row = ParseRow(line);
    if (!row) return Status::Error("{}:{}: expected {} numbers between commas", name, line_number, kColumns);
    const std::string complaint = Complaint(*row);
    if (!complaint.empty()) return Status::Error("{}:{}: {}", name, line_number, complaint);
    if (!path.times_s_.empty() && (*row)[0] <= path.times_s_.back()) {
      return Status::Error("{}:{}: t_s {} is not after {} of the row before", name, line_number, (*row)[0],
                           path.times_s_.back());
    }
    if (path.rows() == kMostRows) return Status::Error("{}:{}: more than {} rows", name, line_number, kMostRows);
    path.AddRow((*row)[0], {{(*row)[1], (*row)[2], (*row)[3]}, (*row)[4], (*row)[5], (*row)[6], (*row)[7]});
  }
  if (path.rows() < 2) return Status::Error("{}: a camera path needs a header and at least two rows", name);
  path.FindSlopes();
  return path;
}

void CameraPath::AddRow(double t_s, const CameraPose& pose) {
  const glm::dvec3 normal = UpAt(pose.position.latitude_deg, pose.position.longitude_deg);
  const auto unwrapped = [&](int series, double degrees) {
    return series_[series].values.empty() ? degrees : Unwrapped(degrees, series_[series].values.back());
  };
  const std::array<double, kSeries> row = {normal.x,
                                           normal.y,
                                           normal.z,
                                           pose.position.height_m,
                                           unwrapped(kHeading, pose.heading_deg),
                                           pose.pitch_deg,
                                           unwrapped(kRoll, pose.roll_deg),
                                           pose.vfov_deg};
  times_s_.push_back(t_s);
  for (int series = 0; series < kSeries; ++series) series_[series].values.push_back(row[static_cast<size_t>(series)]);
}

void CameraPath::FindSlopes() {
  const size_t last = rows() - 1;
  for (int number = 0; number < kSeries; ++number) {
    Series& series = series_[number];
    const bool monotone = number >= kHeight;
    const auto chord = [&](size_t i) {
      return (series.values[i + 1] - series.values[i]) / (times_s_[i + 1] - times_s_[i]);
    };
    series.slopes.assign(rows(), 0.0);
    series.slopes[0] = chord(0);
    series.slopes[last] = chord(last - 1);
    for (size_t i = 1; i < last; ++i) {
      const double before = chord(i - 1), after = chord(i);
      const double span_before = times_s_[i] - times_s_[i - 1], span_after = times_s_[i + 1] - times_s_[i];
      const double mean = (before * span_after + after * span_before) / (span_before + span_after);
      // The smaller of the neighbours' slopes, times 3, bounds a monotone cubic.
      const double limit = before * after <= 0 ? 0.0 : 3.0 * std::min(std::abs(before), std::abs(after));
      series.slopes[i] = monotone ? std::clamp(mean, -limit, limit) : mean;
    }
  }
}

double CameraPath::At(int number, size_t segment, double share) const {
  const Series& series = series_[number];
  const double span_s = times_s_[segment + 1] - times_s_[segment];
  const double u = share, u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * series.values[segment] + (u3 - 2 * u2 + u) * span_s * series.slopes[segment] +
         (3 * u2 - 2 * u3) * series.values[segment + 1] + (u3 - u2) * span_s * series.slopes[segment + 1];
}

CameraPose CameraPath::PoseAt(double elapsed_s) const {
  const double t_s = std::clamp(times_s_.front() + elapsed_s, times_s_.front(), times_s_.back());
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end() - 1, t_s);
  const size_t segment = std::max<size_t>(static_cast<size_t>(after - times_s_.begin()), 1) - 1;
  const double share = (t_s - times_s_[segment]) / (times_s_[segment + 1] - times_s_[segment]);
  const auto at = [&](int series) { return At(series, segment, share); };

  CameraPose pose;
  const glm::dvec3 normal = glm::normalize(glm::dvec3(at(kNormalX), at(kNormalY), at(kNormalZ)));
  pose.position = {std::atan2(normal.z, std::hypot(normal.x, normal.y)) * kDegreesPerRadian,
                   std::atan2(normal.y, normal.x) * kDegreesPerRadian, at(kHeight)};
  pose.heading_deg = at(kHeading);
  pose.pitch_deg = std::clamp(at(kPitch), -90.0, 90.0);
  pose.roll_deg = at(kRoll);
  pose.vfov_deg = at(kVfov);
  return pose;
}

glm::dvec3 CameraPath::EyeAt(double elapsed_s) const {
  return PoseAt(elapsed_s).eye_ecef();
}

glm::dvec3 CameraPath::VelocityAt(double elapsed_s) const {
  constexpr double kStep_s = 1e-3;
  const double from_s = std::max(elapsed_s - kStep_s, 0.0);
  const double to_s = std::min(elapsed_s + kStep_s, length_s());
  if (to_s <= from_s) return glm::dvec3(0.0);
  return (EyeAt(to_s) - EyeAt(from_s)) / (to_s - from_s);
}

}  // namespace belvedere

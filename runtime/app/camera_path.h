// CameraPath: poses of a camera over time, as `belvedere tour` flies them.
//
// A path file is CSV with the header
//   t_s,lat_deg,lon_deg,height_m,heading_deg,pitch_deg,roll_deg,vfov_deg
// and rows of growing t_s; height above the WGS 84 ellipsoid, heading clockwise from north, pitch -90 straight down.
// Between rows the place is a cubic through the rows' normals on the ellipsoid, so that poles and 180 E are places like
// any other; height and angles are monotone cubics (Fritsch and Carlson 1980), which never overshoot a row and so never
// dive below the lower of two rows; heading and roll take the shorter way round.
//
// Units: seconds, degrees, metres.
// Threads: immutable once parsed.
#pragma once

#include "runtime/base/status.h"
#include "runtime/earth/units.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

struct CameraPose {
  Geodetic position;
  double heading_deg = 0, pitch_deg = 0, roll_deg = 0, vfov_deg = 60;
  glm::dvec3 eye_ecef() const;
  glm::dmat3 ecef_from_camera() const;
};

class CameraPath {
 public:
  // name: stands in messages, as "tour.csv:12: ...".
  static Result<CameraPath> Parse(std::string_view text, const std::string& name);
  static Result<CameraPath> Load(const std::string& path);

  double start_s() const { return times_s_.front(); }
  double length_s() const { return times_s_.back() - times_s_.front(); }
  size_t rows() const { return times_s_.size(); }

  // elapsed_s counts from the first row; before it and after the last row the path stands still.
  CameraPose PoseAt(double elapsed_s) const;
  // How the eye moves there, metres a second in ECEF.
  glm::dvec3 VelocityAt(double elapsed_s) const;

 private:
  static constexpr int kSeries = 8;  // normal x, y, z; height; heading, pitch, roll, vfov
  struct Series {
    std::vector<double> values, slopes;
  };

  void AddRow(double t_s, const CameraPose& pose);
  void FindSlopes();
  double At(int series, size_t segment, double share) const;
  glm::dvec3 EyeAt(double elapsed_s) const;

  std::vector<double> times_s_;
  Series series_[kSeries];
};

}  // namespace belvedere

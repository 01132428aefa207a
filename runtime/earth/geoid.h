// Geoid: the height of mean sea level above the WGS 84 ellipsoid, from a NOAA .gtx grid such as the EGM96 grid of 15
// minutes that Debian's proj-data brings, or of posts that the caller has. Bilinear, as PROJ interpolates it.
//
// Units: degrees in, metres out. height above the ellipsoid = height above mean sea level + Height.
// Threads: immutable once loaded; any thread.
#pragma once

#include "runtime/base/status.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace belvedere {

// Posts at whole steps, row by row from the south-west. NaN where there is no value.
struct GeoidGrid {
  std::string path;  // where it is from
  double south_deg = 0, west_deg = 0, latitude_step_deg = 1, longitude_step_deg = 1;
  int rows = 0, columns = 0;
  bool is_round = true;  // its columns close on themselves; else there is no height beyond the outermost posts
  std::vector<float> heights_m;
};

class Geoid {
 public:
  // REQUIRES: two rows and columns or more, and as many heights.
  static std::shared_ptr<const Geoid> Of(GeoidGrid grid);
  static Result<std::shared_ptr<const Geoid>> Load(const std::string& path);
  // egm96_15.gtx, found where PROJ looks for it: PROJ_DATA, PROJ_LIB, then the system's folders.
  static Result<std::shared_ptr<const Geoid>> LoadEgm96();

  // Any longitude; latitude [-90, 90]. NaN where the grid has no value.
  double Height(double latitude_deg, double longitude_deg) const;
  // Every latitude with every longitude, row by row: what Height gives, to the bit.
  std::vector<double> Heights(std::span<const double> latitudes_deg, std::span<const double> longitudes_deg) const;
  const std::string& path() const { return grid_.path; }

 private:
  // Between two rows or columns of the grid.
  struct Place {
    size_t first = 0, second = 0;
    double fraction = 0;
  };
  Place PlaceOfLatitude(double latitude_deg) const;
  Place PlaceOfLongitude(double longitude_deg) const;
  double Interpolate(const Place& row, const Place& column) const;

  GeoidGrid grid_;
};

}  // namespace belvedere

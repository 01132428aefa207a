// Georeference: where a source's pixels lie, between longitude/latitude on WGS 84 and pixel coordinates.
//
// Pixel coordinates are continuous: (0, 0) is the outer corner of the first pixel, (0.5, 0.5) its centre, to which its
// value belongs. The mapping is exact for every point taken alone, so a point has the same pixel coordinates whichever
// page asks. Sources with a geotransform in any CRS, with ground control points, and with RPC coefficients are taken.
//
// Threads: one at a time; Clone for another thread.
#pragma once

#include "preproc/spec.h"
#include "runtime/base/status.h"

#include <memory>
#include <span>
#include <string>

class GDALDataset;

namespace belvedere {

struct PixelPoint {
  double x = 0, y = 0;  // NaN where the position has no pixel coordinates
};

class Georeference {
 public:
  // The reason alone when the dataset has none; the caller names the source.
  static Result<std::unique_ptr<Georeference>> Make(GDALDataset& dataset, const SourceSpec& spec);
  virtual ~Georeference() = default;
  virtual std::unique_ptr<Georeference> Clone() const = 0;

  // x depends on longitude alone and y on latitude alone.
  virtual bool separable() const = 0;
  // The source's columns go once round the Earth and close on themselves.
  virtual bool wraps() const = 0;
  virtual const std::string& crs_name() const = 0;
  // Outer extent, slightly too large rather than too small; west in [-180, 180) or so, east may exceed 180.
  const GeoBox& extent() const { return extent_; }
  // Distance between pixels in degrees at the centre, the smaller of east-west and north-south.
  double spacing_deg() const { return spacing_deg_; }

  virtual PixelPoint ToPixel(double longitude_deg, double latitude_deg) = 0;
  // All of the same length.
  virtual void ToPixels(std::span<const double> longitudes_deg, std::span<const double> latitudes_deg,
                        std::span<PixelPoint> out) = 0;

 protected:
  GeoBox extent_;
  double spacing_deg_ = 1;
};

// Whether two boxes share area, whatever turn their longitudes are given in.
bool Overlap(const GeoBox& a, const GeoBox& b);
// The box, wider by so many metres on every side: at least, and all around where it comes to a pole.
GeoBox Widened(const GeoBox& box, double by_m);
// Whether a position lies in the box or on its border, whatever its turn.
bool Covers(const GeoBox& box, double longitude_deg, double latitude_deg);

}  // namespace belvedere

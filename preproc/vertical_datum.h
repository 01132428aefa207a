// Vertical datum: what a source's heights are above, and how far that lies above the ellipsoid.
//
//   "egm96"        mean sea level by EGM96, as the dataset has it everywhere
//   "ellipsoid"    WGS 84
//   a number       metres above the ellipsoid
//   "EPSG:3855"    a vertical CRS for which PROJ has a grid on this machine
//   FILE           such a grid: GeographicLib's .pgm, or any raster of GDAL's in degrees (.gtx, .tif, .byn, ..)
//
// A spec that says nothing takes what the file says, by the vertical part of its CRS, and EGM96 where it says nothing
// either. Grids are looked up at positions on WGS 84; where a grid has no value the source has none.
//
// Units: metres, degrees. Threads: any; GDAL's drivers must be there.
#pragma once

#include "preproc/spec.h"
#include "runtime/base/status.h"
#include "runtime/earth/geoid.h"

#include <memory>
#include <optional>
#include <string>

class OGRSpatialReference;

namespace belvedere {

// What a CRS says of heights.
struct DeclaredHeights {
  std::optional<VerticalDatum> datum;     // none: nothing, or nothing that is known here
  std::string grid;                       // for kGrid: "EPSG:n"
  std::optional<double> metres_per_unit;  // of its vertical axis
  std::string name;                       // of its vertical part, for people; may be empty
};
DeclaredHeights HeightsDeclaredBy(const OGRSpatialReference& crs);

// Of a vertical CRS "EPSG:n", or a file; only what the box needs of it. Fails with the reason alone.
Result<std::shared_ptr<const Geoid>> LoadGeoidGrid(const std::string& name, const GeoBox& box);

}  // namespace belvedere
